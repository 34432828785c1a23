"""The scanner: from the characters of a line to the words of a Block.

A line is first stripped of blanks and put into lower case outside comments (``strip``); everything after that works on the
stripped text, with plain C values. Expressions and parameters are evaluated on the way: a parameter setting takes
effect when the whole line was read. Errors name the place in the stripped text; the interpreter finds the column from it.
"""

from libc.math cimport acos, asin, atan2, ceil, cosl, exp, fabs, floor, fmod, isinf, isnan, log, pow, sinl, sqrt, tanl
from libc.stdlib cimport strtod
from libc.string cimport memcpy, memset, strncmp

from rs274ngc.block cimport *
from rs274ngc.modal cimport g_code, g_group, m_code, m_group, m_steps, word_step
from rs274ngc.params cimport get_named, get_numbered, named_exists, set_named, set_numbered
from rs274ngc.state cimport PARAMETERS, State, fail

cdef extern from *:
    """
    static const long double LONG_PI = 3.141592653589793238462643383279502884L;
    """
    const long double LONG_PI       # LinuxCNC turns degrees to radians and back in extended precision

cdef double INTEGER_TOLERANCE = 0.0001
cdef double EQUAL_TOLERANCE = 0.000001     # EQ and NE of expressions

cdef double[23] POWER_OF_TEN
cdef int power
for power in range(23):
    POWER_OF_TEN[power] = 10.0**power


cdef int[WORDS] AXIS_OF_WORD        # 0 X .. 8 W; -1: no axis word
for power in range(WORDS):
    AXIS_OF_WORD[power] = "xyzabcuvw".find(chr(97 + power)) if power < 26 else -1


# --- Stripping

cdef int strip(State s) except -1:
    """Fill ``s.text`` from ``s.raw``: no blanks, lower case, but comments as they are written."""
    cdef const char* raw = s.raw
    cdef char* text = s.text
    cdef int i, n = 0
    cdef bint comment = False
    cdef char c
    for i in range(s.raw_size):
        c = raw[i]
        if comment:
            text[n] = c
            n += 1
            if c == c')':
                comment = False
            elif c == c'(':
                return fail(s, "Nested comment found", n - 1)
        elif c == c' ' or c == c'\t' or c == c'\r':
            continue
        elif c == c';':
            memcpy(text + n, raw + i, s.raw_size - i)
            n += s.raw_size - i
            break
        else:
            if c'A' <= c <= c'Z':
                c += 32
            elif c == c'(':
                comment = True
            text[n] = c
            n += 1
    text[n] = 0
    s.size = n
    if comment:
        return fail(s, "Unclosed comment found", n - 1)
    return 0


# --- Numbers and values

cdef int read_number(State s, int* at, double* out) except -1:
    """Digits with a sign and a point; exact, by a double division where that is exact, else by the C library."""
    cdef const char* text = s.text
    cdef int i = at[0], start = at[0], digits = 0, decimals = 0
    cdef unsigned long long mantissa = 0
    cdef bint negative = False, point = False
    cdef char c
    if text[i] == c'-':
        negative = True
        i += 1
    elif text[i] == c'+':
        i += 1
    while True:
        c = text[i]
        if c'0' <= c <= c'9':
            digits += 1
            if digits <= 18:
                mantissa = mantissa * 10 + <unsigned int>(c - c'0')
            decimals += point
        elif c == c'.' and not point:
            point = True
        else:
            break
        i += 1
    if c == c'.':
        return fail(s, f"bad number format (trailing characters) parsing '{number_text(s, start)}'", start)
    if digits == 0:
        return fail(s, f"bad number format (conversion failed) parsing '{number_text(s, start)}'", start)
    if digits <= 18 and mantissa < (1ULL << 53) and decimals <= 22:
        out[0] = <double>mantissa / POWER_OF_TEN[decimals]
        if negative:
            out[0] = -out[0]
    else:
        out[0] = strtod(text + start, NULL)
    at[0] = i
    return 0


cdef str number_text(State s, int start):
    cdef int end = start
    while s.text[end] and s.text[end] in b"0123456789." or (end == start and s.text[end] in b"+-"):
        end += 1
    return s.text[start:end].decode("latin-1")


cdef int read_value(State s, int* at, double* out, int depth=0) except -1:
    """A number, a parameter, an expression in brackets or a function: whatever may follow a letter."""
    cdef char c = s.text[at[0]]
    if c'0' <= c <= c'9' or c == c'.':
        return read_number(s, at, out)
    if depth > DEPTH_MAX:
        return fail(s, "Expression nested too deeply", at[0])
    if (c == c'-' or c == c'+') and s.text[at[0] + 1] == 0:
        return read_number(s, at, out)
    if c == 0:
        return fail(s, "No characters found in reading real value", at[0])
    if c == c'[':
        read_expression(s, at, out, depth + 1)
    elif c == c'#':
        read_parameter(s, at, out, depth + 1)
    elif c == c'+' or c == c'-':
        if c'0' <= s.text[at[0] + 1] <= c'9' or s.text[at[0] + 1] == c'.':
            return read_number(s, at, out)
        at[0] += 1
        read_value(s, at, out, depth + 1)
        if c == c'-':
            out[0] = -out[0]
    elif c'a' <= c <= c'z':
        read_function(s, at, out, depth + 1)
    else:
        return read_number(s, at, out)
    if isnan(out[0]):
        return fail(s, "Calculation resulted in 'not a number'", at[0])
    if isinf(out[0]):
        return fail(s, "Calculation resulted in 'infinity'", at[0])
    return 0


cdef int read_integer(State s, int* at, int* out) except -1:
    """A value that must be whole, within 0.0001."""
    cdef double value
    cdef int start = at[0]
    read_value(s, at, &value)
    if fabs(value) > 2.0e9:
        return fail(s, "Non integer value for integer", start)
    out[0] = <int>floor(value + 0.5)
    if fabs(value - out[0]) > INTEGER_TOLERANCE:
        return fail(s, "Non integer value for integer", start)
    return 0


cdef int read_unsigned(State s, int* at, int* out) except -1:
    """Digits, nothing else."""
    cdef int i = at[0]
    cdef long value = 0
    while c'0' <= s.text[i] <= c'9':
        if value < 1000000000000:
            value = value * 10 + (s.text[i] - c'0')
        i += 1
    if i == at[0] or value > 2147483647:
        return fail(s, "Bad format unsigned integer", at[0])
    out[0] = <int>value
    at[0] = i
    return 0


cdef str read_name(State s, int* at):
    """``<name>``: the name between the angle brackets; ``at`` stands on the opening one."""
    cdef int start = at[0] + 1, i = at[0] + 1
    while s.text[i] and s.text[i] != c'>':
        i += 1
    if s.text[i] == 0:
        fail(s, "Named parameter not terminated", at[0])
    at[0] = i + 1
    return s.text[start:i].decode("latin-1")


cdef int read_parameter_number(State s, int* at, int* out, int depth) except -1:
    cdef double value
    cdef int start = at[0]
    read_value(s, at, &value, depth)
    if fabs(value) > 2.0e9 or fabs(value - floor(value + 0.5)) > INTEGER_TOLERANCE:
        return fail(s, "Non integer value for integer", start)
    out[0] = <int>floor(value + 0.5)
    return 0


cdef int read_parameter(State s, int* at, double* out, int depth) except -1:
    """``#5``, ``##5``, ``#[..]``, ``#<name>``; ``at`` stands on the number sign."""
    cdef int number, start = at[0]
    at[0] += 1
    if s.text[at[0]] == c'<':
        name = read_name(s, at)
        out[0] = get_named(s, name, start)
        return 0
    read_parameter_number(s, at, &number, depth)
    return get_numbered(s, number, out, start)


# --- Expressions

cdef enum:
    OP_END = 0
    OP_POWER, OP_DIVIDE, OP_MODULO, OP_TIMES, OP_AND, OP_OR, OP_XOR, OP_MINUS, OP_PLUS
    OP_NE, OP_EQ, OP_LT, OP_LE, OP_GE, OP_GT

cdef int[16] PRECEDENCE
PRECEDENCE[:] = [0, 5, 4, 4, 4, 1, 1, 1, 3, 3, 2, 2, 2, 2, 2, 2]


cdef inline bint word_is(const char* text, const char* word, int size) noexcept nogil:
    cdef int i
    for i in range(size):
        if text[i] != word[i]:
            return False
    return True


cdef int read_operation(State s, int* at) except -1:
    """The operator between two values, or the closing bracket."""
    cdef const char* t = s.text + at[0]
    cdef int op = -1, size = 1
    if t[0] == c'+':
        op = OP_PLUS
    elif t[0] == c'-':
        op = OP_MINUS
    elif t[0] == c'/':
        op = OP_DIVIDE
    elif t[0] == c'*':
        op = OP_TIMES
        if t[1] == c'*':
            op = OP_POWER
            size = 2
    elif t[0] == c']':
        op = OP_END
    elif t[0] == 0:
        return fail(s, "Unclosed expression", at[0])
    elif word_is(t, b"mod", 3):
        op, size = OP_MODULO, 3
    elif word_is(t, b"and", 3):
        op, size = OP_AND, 3
    elif word_is(t, b"xor", 3):
        op, size = OP_XOR, 3
    elif word_is(t, b"or", 2):
        op, size = OP_OR, 2
    elif word_is(t, b"eq", 2):
        op, size = OP_EQ, 2
    elif word_is(t, b"ne", 2):
        op, size = OP_NE, 2
    elif word_is(t, b"le", 2):
        op, size = OP_LE, 2
    elif word_is(t, b"lt", 2):
        op, size = OP_LT, 2
    elif word_is(t, b"ge", 2):
        op, size = OP_GE, 2
    elif word_is(t, b"gt", 2):
        op, size = OP_GT, 2
    elif t[0] in b"aeglmnox":
        return fail(s, f"Unknown operation name starting with {chr(t[0])}", at[0])
    else:
        return fail(s, "Unknown operation", at[0])
    at[0] += size
    return op


cdef int apply(State s, int op, double* left, double right, int at) except -1:
    """left = left op right; truth is 1.0 and 0.0."""
    cdef double l = left[0]
    if op == OP_PLUS:
        left[0] = l + right
    elif op == OP_MINUS:
        left[0] = l - right
    elif op == OP_TIMES:
        left[0] = l * right
    elif op == OP_DIVIDE:
        if right == 0.0:
            return fail(s, "Attempt to divide by zero", at)
        left[0] = l / right
    elif op == OP_MODULO:
        left[0] = fmod(l, right)
        if left[0] < 0.0:
            left[0] += fabs(right)
    elif op == OP_POWER:
        if l < 0.0 and floor(right) != right:
            return fail(s, "Attempt to raise negative to non integer power", at)
        left[0] = pow(l, right)
    elif op == OP_AND:
        left[0] = 1.0 if l != 0.0 and right != 0.0 else 0.0
    elif op == OP_OR:
        left[0] = 1.0 if l != 0.0 or right != 0.0 else 0.0
    elif op == OP_XOR:
        left[0] = 1.0 if (l != 0.0) != (right != 0.0) else 0.0
    elif op == OP_EQ:
        left[0] = 1.0 if fabs(l - right) < EQUAL_TOLERANCE else 0.0
    elif op == OP_NE:
        left[0] = 1.0 if fabs(l - right) >= EQUAL_TOLERANCE else 0.0
    elif op == OP_LT:
        left[0] = 1.0 if l < right else 0.0
    elif op == OP_LE:
        left[0] = 1.0 if l <= right else 0.0
    elif op == OP_GE:
        left[0] = 1.0 if l >= right else 0.0
    else:
        left[0] = 1.0 if l > right else 0.0
    return 0


cdef int read_expression(State s, int* at, double* out, int depth) except -1:
    """``[value operator value ...]``: binary operators by precedence, equal ones from the left."""
    cdef double[6] values
    cdef int[6] operators
    cdef int top = 0, op
    at[0] += 1
    read_value(s, at, &values[0], depth)
    op = read_operation(s, at)
    while True:
        while top > 0 and PRECEDENCE[operators[top - 1]] >= PRECEDENCE[op]:
            apply(s, operators[top - 1], &values[top - 1], values[top], at[0])
            top -= 1
        if op == OP_END:
            break
        operators[top] = op
        top += 1
        read_value(s, at, &values[top], depth)
        op = read_operation(s, at)
    out[0] = values[0]
    return 0


cdef enum:
    F_ABS, F_ACOS, F_ASIN, F_ATAN, F_COS, F_EXP, F_FIX, F_FUP, F_LN, F_ROUND, F_SIN, F_SQRT, F_TAN, F_EXISTS

FUNCTIONS = {
    "abs": F_ABS, "acos": F_ACOS, "asin": F_ASIN, "atan": F_ATAN, "cos": F_COS, "exp": F_EXP, "fix": F_FIX, "fup": F_FUP,
    "ln": F_LN, "round": F_ROUND, "sin": F_SIN, "sqrt": F_SQRT, "tan": F_TAN, "exists": F_EXISTS,
}
"""The functions of expressions: angles in degrees."""


cdef int read_function(State s, int* at, double* out, int depth) except -1:
    cdef int end = at[0], start = at[0], function
    cdef double other
    while c'a' <= s.text[end] <= c'z':
        end += 1
    name = s.text[start:end].decode("latin-1")
    function = FUNCTIONS.get(name, -1)
    if function < 0:
        if name[0] in "aceflrst":
            return fail(s, f"Unknown word starting with {name[0]}", start)
        return fail(s, "Unknown word where unary operation could be", start)
    at[0] = end
    if s.text[end] != c'[':
        if function == F_ATAN or function == F_EXISTS:
            return fail(s, f"Left bracket missing after {name}", end)
        return fail(s, "Left bracket missing after unary operation name", end)
    if function == F_EXISTS:
        return read_exists(s, at, out, depth)
    read_expression(s, at, out, depth)
    if function == F_ATAN:
        if s.text[at[0]] != c'/':
            return fail(s, "Slash missing after first atan argument", at[0])
        at[0] += 1
        if s.text[at[0]] != c'[':
            return fail(s, "Left bracket missing after slash with atan", at[0])
        read_expression(s, at, &other, depth)
        out[0] = degrees(atan2(out[0], other))
        return 0
    return apply_function(s, function, out, start)


cdef inline double degrees(double radians) noexcept:
    return <double>(radians * 180.0 / LONG_PI)


cdef int apply_function(State s, int function, double* x, int at) except -1:
    cdef double v = x[0]
    if function == F_ABS:
        x[0] = fabs(v)
    elif function == F_ACOS:
        if v < -1.0 or v > 1.0:
            return fail(s, "Argument to acos out of range", at)
        x[0] = degrees(acos(v))
    elif function == F_ASIN:
        if v < -1.0 or v > 1.0:
            return fail(s, "Argument to asin out of range", at)
        x[0] = degrees(asin(v))
    elif function == F_COS:
        x[0] = <double>cosl(v * LONG_PI / 180.0)
    elif function == F_EXP:
        x[0] = exp(v)
    elif function == F_FIX:
        x[0] = floor(v)
    elif function == F_FUP:
        x[0] = ceil(v)
    elif function == F_LN:
        if v <= 0.0:
            return fail(s, "Zero or negative argument to ln", at)
        x[0] = log(v)
    elif function == F_ROUND:
        x[0] = <double>(<long>(v + (-0.5 if v < 0.0 else 0.5))) if fabs(v) < 9e18 else v
    elif function == F_SIN:
        x[0] = <double>sinl(v * LONG_PI / 180.0)
    elif function == F_SQRT:
        if v < 0.0:
            return fail(s, "Negative argument to sqrt", at)
        x[0] = sqrt(v)
    else:
        x[0] = <double>tanl(v * LONG_PI / 180.0)
    return 0


cdef int read_exists(State s, int* at, double* out, int depth) except -1:
    """``exists[#<name>]``, ``exists[#5]``"""
    cdef int number
    if s.text[at[0] + 1] != c'#':
        return fail(s, "Expected # reading parameter", at[0] + 1)
    at[0] += 2
    if s.text[at[0]] == c'<':
        out[0] = named_exists(s, read_name(s, at))
    else:
        read_parameter_number(s, at, &number, depth)
        out[0] = 0 < number < PARAMETERS - 1
    if s.text[at[0]] != c']':
        return fail(s, "Expected ] reading bracketed parameter", at[0])
    at[0] += 1
    return 0


# --- The words of a line

cdef int skip_comments(State s, int* at) except -1:
    """Step over comments, keep in mind the last; False at the end of the line."""
    cdef int i = at[0], start
    while True:
        if s.text[i] == c'(':
            start = i + 1
            while s.text[i] != c')':
                i += 1
            s.block.comment = start
            s.block.comment_size = i - start
            i += 1
        elif s.text[i] == c';':
            if i == 0 and strncmp(s.text, b";py,", 4) == 0:
                s.block.comment = 1
                s.block.comment_size = s.size - 1
            at[0] = s.size
            return 0
        else:
            break
    at[0] = i
    return s.text[i] != 0


cdef int scan_words(State s, int at) except -1:
    """Read everything on a line from ``at`` on into ``s.block``; parameters are set at the end."""
    cdef Block* b = &s.block
    cdef int[MAX_SETTINGS] numbers
    cdef double[MAX_SETTINGS] values
    cdef int settings = 0, k, i = at, word, start
    cdef double value
    cdef char c
    names = None
    while True:
        c = s.text[i]
        if c'a' <= c <= c'z':
            word = c - c'a'
        elif c == c'(' or c == c';':
            if not skip_comments(s, &i):
                break
            continue
        elif c == 0:
            break
        elif c == c'#':
            start = i
            if s.text[i + 1] == c'<':
                i += 1
                name = read_name(s, &i)
                read_assigned(s, &i, &value)
                names = names or []
                names.append((name, value, start))
                continue
            i += 1
            read_parameter_number(s, &i, &numbers[settings], 0)
            read_assigned(s, &i, &values[settings])
            settings += 1
            if settings == MAX_SETTINGS:
                return fail(s, "Too many parameter settings on one line", start)
            continue
        elif c == c'$':
            word = W_DOLLAR
        elif c == c'@':
            word = W_AT
        elif c == c'^':
            word = W_CARET
        else:
            return bad_character(s, c, i)
        start = i
        i += 1
        if word == W_G:
            read_g(s, b, &i, start)
        elif word == W_M:
            read_m(s, b, &i, start)
        else:
            read_word(s, b, word, &i, start)
    for k in range(settings):
        set_numbered(s, numbers[k], values[k])
    if names is not None:
        for name, assigned, place in names:
            set_named(s, name, assigned, place)
    return 0


cdef int bad_character(State s, char c, int at) except -1:
    cdef unsigned char code = <unsigned char>c
    if 32 < code < 127:
        return fail(s, f"Bad character '{chr(code)}' used", at)
    return fail(s, f"Bad character '\\{code:03o}' used", at)


cdef int read_assigned(State s, int* at, double* out) except -1:
    if s.text[at[0]] != c'=':
        return fail(s, "Equal sign missing in parameter setting", at[0])
    at[0] += 1
    return read_value(s, at, out)


cdef int read_g(State s, Block* b, int* at, int start) except -1:
    cdef double value
    cdef int code, group
    read_value(s, at, &value)
    value *= 10.0
    if fabs(value) > 1.0e9:
        return fail(s, "G-code out of range", start)
    code = <int>floor(value)
    if value - code > 0.999:
        code += 1
    elif value - code > 0.001:
        return fail(s, "G-code out of range", start)
    if code > 999:
        return fail(s, "G-code out of range", start)
    if code < 0:
        return fail(s, "Negative g code used", start)
    group = g_group[code]
    if s.remaps and f"G{code}" in s.remaps:
        group = 1
    if group < 0:
        return fail(s, "Unknown g code used", start)
    if code == 800 and b.g[group] >= 0:     # beside another motion G80 says nothing
        return 0
    if b.g[group] >= 0 and b.g[group] != 800:
        return fail(s, "Two g codes used from same modal group", start)
    b.g[group] = code
    b.g_at[group] = start
    b.steps |= g_code[code].step if group != 1 else 0
    return 0


cdef int read_m(State s, Block* b, int* at, int start) except -1:
    cdef int code, group
    read_integer(s, at, &code)
    if code < 0:
        return fail(s, "Negative m code used", start)
    remap = s.remaps.get(f"M{code}") if s.remaps else None
    if remap is not None:
        group = remap.group
        b.steps |= m_steps[group]
    elif code > 199:
        return fail(s, f"M-code greater than 199: M{code}", start)
    else:
        group = m_group[code]
        if group < 0:
            return fail(s, f"Unknown m code used: M{code}", start)
        b.steps |= m_code[code].step
    if b.m[group] >= 0:
        return fail(s, "Two m codes used from same modal group", start)
    b.m[group] = code
    b.m_at[group] = start
    b.m_count += 1
    return 0


cdef int read_word(State s, Block* b, int word, int* at, int start) except -1:
    """A letter that takes a value; some must be whole or not negative."""
    cdef int whole
    cdef double value
    if word_step[word] < 0 or (AXIS_OF_WORD[word] >= 0 and not (s.axis_mask >> AXIS_OF_WORD[word]) & 1 and not s.profile):
        return bad_character(s, s.text[start], start)
    if has(b, word):
        return fail(s, repeated(word), start)
    if word == W_H or word == W_T or word == W_L:
        read_integer(s, at, &whole)
        value = whole
    else:
        read_value(s, at, &value)
    if value < 0.0:
        if word == W_H and value != MISSING:
            return fail(s, "Negative h word used", start)
        if word == W_F:
            return fail(s, "Negative f word used", start)
        if word == W_L:
            return fail(s, "Negative l word used", start)
        if word == W_S:
            return fail(s, "Negative spindle speed used", start)
        if word == W_T:
            return fail(s, "Negative tool id (tool not found)", start)
    b.value[word] = value
    b.words |= 1 << word
    b.at[word] = start
    b.steps |= 1ULL << word_step[word] if word_step[word] else 0
    return 0


cdef str repeated(int word):
    if word == W_DOLLAR:
        return "Multiple spindle choice ($) words on one line"
    if word >= W_AT:
        return f"Multiple {'@^'[word - W_AT]} words on one line"
    letter = chr(ord("a") + word)
    return f"Multiple {letter.upper() if letter in 'uvw' else letter} words on one line"

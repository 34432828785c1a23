"""Parameters: #1 to #5602, #<local>, #<_global> and the predefined ones.

Numbered parameters are a C array; named ones are dictionaries, one for the program and one for each call level.
"""

from libc.math cimport isinf, isnan

from nml.errors import InterpError
from rs274ngc.predefined import PREDEFINED
from rs274ngc.state cimport FEATURE_HAL_PIN_VARS, FEATURE_INI_VARS, PARAMETERS, State, fail

READ_ONLY = frozenset((*range(5021, 5030), *range(5081, 5090), *range(5400, 5414), *range(5420, 5429)))
"""Numbered parameters that a program cannot set."""


cdef int get_numbered(State s, int number, double* out, int at) except -1:
    if number < 1 or number >= PARAMETERS:
        return fail(s, "Parameter number out of range", at)
    if 5420 <= number <= 5428:
        out[0] = s.pos[number - 5420]
    elif 5021 <= number <= 5029:
        out[0] = s.machine_position[number - 5021]
    elif 5081 <= number <= 5089:
        out[0] = s.tool[number - 5081]
    else:
        out[0] = s.params[number]
    return 0


cdef int set_numbered(State s, int number, double value) except -1:
    if number < 1 or number >= PARAMETERS:
        return fail(s, "Parameter number out of range")
    if number in READ_ONLY:
        return fail(s, "Parameter is readonly")
    s.params[number] = value
    return 0


def outside_value(State s, str name):
    """``_ini[SECTION]KEY`` and ``_hal[pin]``: a number from the INI file or from a HAL item; None: no such thing."""
    if name.startswith("_ini[") and s.features & FEATURE_INI_VARS:
        section, _, key = name[5:].partition("]")
        text = s.ini.find(section.upper(), key.upper()) if s.ini is not None else None
        if text is None:
            raise InterpError(f"Named parameter #<{name}> not defined")
        try:
            return float(text)
        except ValueError:
            raise InterpError(f"Named INI parameter #<{name}> is not a number: '{text}'") from None
    if name.startswith("_hal[") and s.features & FEATURE_HAL_PIN_VARS:
        value = s.canon.get_external_parameter(name)
        if value is None:
            raise InterpError(f"Named hal parameter #<{name}> not found")
        return float(value)
    return None


cdef double get_named(State s, str name, int at) except? -1.0e300:
    value = s.globals.get(name) if name.startswith("_") else s.frame.named.get(name)
    if value is not None:
        return value
    if s.plugin is not None and name in s.plugin.named:
        return s.plugin.parameter(name)
    known = PREDEFINED.get(name)
    if known is not None:
        return known(s)
    try:
        value = outside_value(s, name)
    except InterpError:
        s.error_at = at
        raise
    if value is not None and name.startswith("_ini["):
        s.globals[name] = value     # the file does not change, and lists of names show what was asked for
    if value is None and name.startswith("_"):
        value = s.canon.get_external_parameter(name)
    if value is None:
        fail(s, f"Named parameter #<{name}> not defined", at)
    return value


cdef int set_named(State s, str name, double value, int at) except -1:
    if name in PREDEFINED or name.startswith(("_ini[", "_hal[")):
        return fail(s, f"Cannot assign to read-only parameter #<{name}>", at)
    if name.startswith("_"):
        s.globals[name] = value
    else:
        s.frame.named[name] = value
    return 0


cdef bint named_exists(State s, str name) except -1:
    if name in PREDEFINED or (s.plugin is not None and name in s.plugin.named):
        return True
    if name.startswith("_"):
        if name in s.globals:
            return True
        try:
            return outside_value(s, name) is not None or s.canon.get_external_parameter(name) is not None
        except InterpError:
            return False
    return name in s.frame.named

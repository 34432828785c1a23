"""The .comp language: the declarations above ``;;``, read into a `Component`; what follows is C and kept as it is.

The chapter "HAL Component Generator" of LinuxCNC's manual describes it. `CompError` names the place of a mistake.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import combinations

from nml.errors import PyemcError

TYPES = {
    "bit": "bit", "bool": "bit", "float": "float", "real": "float",
    "signed": "s32", "s32": "s32", "si32": "s32", "unsigned": "u32", "u32": "u32", "ui32": "u32",
    "s64": "s64", "si64": "s64", "sint": "s64", "u64": "u64", "ui64": "u64", "uint": "u64",
}  # fmt: skip
SET_BY_CALL = frozenset({"bool", "real", "sint", "uint", "si32", "ui32"})
"""Types of which the code also writes ``NAME_set(value)``, as LinuxCNC's of 2026 must."""
PIN_DIRECTIONS = {"in": "HAL_IN", "out": "HAL_OUT", "io": "HAL_IO"}
PARAM_DIRECTIONS = {"r": "HAL_RO", "rw": "HAL_RW"}
TEXTS = ("description", "examples", "notes", "see_also", "license", "author")
OPTIONS = (
    "singleton", "default_count", "count_function", "rtapi_app", "data", "extra_setup", "extra_cleanup", "post_export",
    "userspace", "userinit", "extra_link_args", "extra_compile_args", "constructable", "homemod", "tpmod", "period",
)  # fmt: skip
NOT_POSSIBLE = {
    "homemod": "homing is part of motmod here",
    "tpmod": "the trajectory planner is part of motmod here",
}
LONGEST_ARRAY = 256

TOKEN = re.compile(
    r"""(?P<space>\s+|//[^\n]*|/\*.*?\*/)
    |(?P<string>r?\"\"\".*?\"\"\"|r?"(?:\\.|[^"\\\n])*")
    |(?P<header><[^>\n]+>)
    |(?P<number>0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)
    |(?P<name>\*+[A-Za-z_][\w]*|[A-Za-z_#](?:[-.\w#]*[\w#])?|[A-Za-z_])
    |(?P<mark>==|!=|<=|>=|&&|\|\||<<|>>|[][();:=<>?&|^~!+*/%-])""",
    re.VERBOSE | re.DOTALL,
)


class CompError(PyemcError):
    """A declaration is wrong: file, line and column, what, and the line itself."""

    def __init__(self, file: str, text: str, at: int, what: str) -> None:
        line, start = text.count("\n", 0, at) + 1, text.rfind("\n", 0, at) + 1
        shown = text[start:].partition("\n")[0]
        super().__init__(f"{file}:{line}:{at - start + 1}: {what}\n>  {shown}\n>  {' ' * (at - start)}^")


@dataclass(frozen=True)
class Token:
    kind: str
    text: str
    at: int


@dataclass
class Item:
    """A pin or a parameter. ``size`` 0: a single one; ``how_many`` and ``condition`` are C, of the personality."""

    is_pin: bool
    direction: str
    type: str
    name: str
    at: int
    size: int = 0
    how_many: str = ""
    condition: str = ""
    value: str = ""
    doc: str = ""
    set_by_call: bool = False


@dataclass
class Function:
    name: str
    at: int
    uses_fp: bool = True
    doc: str = ""


@dataclass
class Variable:
    type: str
    name: str
    stars: str = ""
    size: str = ""
    value: str = ""


@dataclass
class Component:
    """One .comp file."""

    file: str
    name: str = ""
    doc: str = ""
    items: list[Item] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    variables: list[Variable] = field(default_factory=list)
    options: dict[str, str] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    includes: list[str] = field(default_factory=list)
    code: str = ""
    code_line: int = 1

    def option(self, name: str) -> bool:
        """Whether a yes-or-no option is on; ``rtapi_app`` is on by itself."""
        return self.options.get(name, "yes" if name == "rtapi_app" else "no").lower() not in ("no", "0", "false")

    @property
    def has_personality(self) -> bool:
        return any(item.condition or item.how_many for item in self.items)

    @property
    def hal_name(self) -> str:
        """What the names of its pins begin with."""
        return to_hal(self.name.removeprefix("hal_"))


def to_hal(name: str) -> str:
    """A HALNAME as the HAL shows it, with a printf field for the number of an array item."""
    return re.sub("#+", lambda marks: f"%0{len(marks[0])}d", name.replace("_", "-")).rstrip("-.")


def to_c(name: str) -> str:
    """A HALNAME as a C identifier."""
    return re.sub("_+", "_", re.sub("[-.]", "_", re.sub("[-._]*#+", "", name)))


def read(file: str, text: str) -> Component:
    """The component that the text of a .comp file declares."""
    return _Parser(file, text).component()


class _Parser:
    def __init__(self, file: str, text: str) -> None:
        self.file, self.text = file, text
        divider = re.search(r"^[ \t]*;;[ \t]*$", text, re.MULTILINE)
        if divider is None:
            raise CompError(file, text, len(text.rstrip()), "there is no line with ';;' between declarations and code")
        self.made = Component(file, code=text[divider.end() + 1 :], code_line=text.count("\n", 0, divider.end()) + 2)
        self.tokens = self._split(divider.start())
        self.next = 0

    def _split(self, end: int) -> list[Token]:
        found, at = [], 0
        while at < end:
            match = TOKEN.match(self.text, at, end)
            if match is None:
                raise self.wrong(at, f"{self.text[at]!r} belongs to no declaration")
            if match.lastgroup != "space":
                found.append(Token(match.lastgroup or "", match[0], at))
            at = match.end()
        return [*found, Token("end", ";;", end)]

    def wrong(self, at: int, what: str) -> CompError:
        return CompError(self.file, self.text, at, what)

    # ---- tokens ----

    @property
    def token(self) -> Token:
        return self.tokens[self.next]

    def take(self, kind: str, what: str) -> Token:
        """The next token, which must be of this kind."""
        token = self.token
        if token.kind != kind:
            raise self.wrong(token.at, f"{what} is expected here, not {token.text!r}")
        self.next += 1
        return token

    def mark(self, text: str) -> None:
        if self.token.text != text:
            raise self.wrong(self.token.at, f"{text!r} is expected here, not {self.token.text!r}")
        self.next += 1

    def comes(self, *texts: str) -> bool:
        """Take the next token if it is one of these."""
        found = self.token.text in texts
        self.next += found
        return found

    def choice(self, of: dict[str, str], what: str) -> str:
        token = self.take("name", what)
        if token.text not in of:
            raise self.wrong(token.at, f"{token.text!r} is no {what}: {', '.join(of)}")
        return of[token.text]

    def string(self) -> str:
        """A text, or "" where none comes."""
        if self.token.kind != "string":
            return ""
        self.next += 1
        return str(ast.literal_eval(self.tokens[self.next - 1].text))

    def expression(self, *ends: str) -> str:
        """C up to one of these marks, a text, or the declaration's end."""
        words, depth = [], 0
        while self.token.kind not in ("end", "string") and (depth or self.token.text not in (*ends, ";")):
            depth += {"(": 1, ")": -1}.get(self.token.text, 0)
            words.append(self.token.text)
            self.next += 1
        if not words:
            raise self.wrong(self.token.at, "an expression is expected here")
        return " ".join(words)

    # ---- declarations ----

    def component(self) -> Component:
        readers: dict[str, Callable[[], None]] = {
            "component": self.read_component, "pin": self.read_pin, "param": self.read_param,
            "function": self.read_function, "option": self.read_option, "variable": self.read_variable,
            "include": self.read_include, **dict.fromkeys(TEXTS, self.read_text),
        }  # fmt: skip
        while self.token.kind != "end":
            token = self.take("name", "a declaration")
            if token.text not in readers:
                raise self.wrong(token.at, f"{token.text!r} is no declaration: {', '.join(readers)}")
            if token.text != "component" and not self.made.name:
                raise self.wrong(token.at, "the first declaration must be 'component NAME;'")
            readers[token.text]()
            self.mark(";")
        self.check()
        return self.made

    def read_component(self) -> None:
        token = self.take("name", "the component's name")
        if self.made.name:
            raise self.wrong(token.at, f"the component has a name already: {self.made.name!r}")
        self.made.name, self.made.doc = token.text, self.string()

    def read_pin(self) -> None:
        self.read_item(True, self.choice(PIN_DIRECTIONS, "direction of a pin"))

    def read_param(self) -> None:
        self.read_item(False, self.choice(PARAM_DIRECTIONS, "direction of a parameter"))

    def read_item(self, is_pin: bool, direction: str) -> None:
        set_by_call = self.token.text in SET_BY_CALL and direction != PIN_DIRECTIONS["in"]
        type_ = self.choice(TYPES, "type")
        token = self.take("name", "a name")
        item = Item(is_pin, direction, type_, token.text, token.at, set_by_call=set_by_call)
        if self.comes("["):
            item.size = self.number("the size of the array")
            item.how_many = self.expression("]") if self.comes(":") else ""
            self.mark("]")
        if bool(item.size) != ("#" in item.name):
            raise self.wrong(token.at, f"{item.name!r}: '#' in the name and [SIZE] behind it belong together")
        if item.size > LONGEST_ARRAY:
            raise self.wrong(token.at, f"an array of {item.size}: up to {LONGEST_ARRAY} are possible")
        item.condition = self.expression("=") if self.comes("if") else ""
        item.value = self.expression() if self.comes("=") else ""
        item.doc = self.string()
        self.made.items.append(item)

    def number(self, what: str) -> int:
        token = self.take("number", what)
        try:
            return int(token.text, 0)
        except ValueError:
            raise self.wrong(token.at, f"{what} is a whole number, not {token.text!r}") from None

    def read_function(self) -> None:
        token = self.take("name", "a name")
        fp = not self.comes("nofp")
        self.comes("fp")
        self.made.functions.append(Function(token.text, token.at, fp, self.string()))

    def read_option(self) -> None:
        token = self.take("name", "an option")
        if token.text not in OPTIONS:
            raise self.wrong(token.at, f"{token.text!r} is no option: {', '.join(OPTIONS)}")
        value = self.string() if self.token.kind == "string" else self.expression() if self.token.text != ";" else "yes"
        self.made.options[token.text] = value
        if token.text in NOT_POSSIBLE and self.made.option(token.text):
            raise self.wrong(token.at, f"option {token.text}: {NOT_POSSIBLE[token.text]}")

    def read_variable(self) -> None:
        words = [self.take("name", "a type").text]
        while self.token.kind == "name" and self.tokens[self.next + 1].kind == "name":
            words.append(self.take("name", "a type").text)
        name = self.take("name", "a name").text
        plain = name.lstrip("*")
        variable = Variable(" ".join(words), plain, "*" * (len(name) - len(plain)))
        if self.comes("["):
            variable.size = self.expression("]")
            self.mark("]")
        variable.value = self.expression() if self.comes("=") else ""
        self.string()
        self.made.variables.append(variable)

    def read_include(self) -> None:
        token = self.token
        self.next += 1
        if token.kind not in ("string", "header"):
            raise self.wrong(token.at, 'a header is expected here: "file.h" or <file.h>')
        self.made.includes.append(token.text)

    def read_text(self) -> None:
        word = self.tokens[self.next - 1]
        if self.token.kind != "string":
            raise self.wrong(self.token.at, f"{word.text} needs a text in quotes")
        self.made.texts[word.text] = self.string()

    # ---- the whole ----

    def check(self) -> None:
        """What no single declaration shows."""
        made, end = self.made, self.tokens[-1].at
        if not made.name:
            raise self.wrong(end, "there is no declaration 'component NAME;'")
        if "license" not in made.texts:
            raise self.wrong(end, "there is no declaration 'license \"...\";'")
        if made.option("userspace") and made.functions:
            raise self.wrong(made.functions[0].at, "a userspace component has no functions; user_mainloop() works")
        self._check_identifiers()
        self._check_hal_names()

    def _check_identifiers(self) -> None:
        taken: dict[str, str] = {}
        entries: list[Item | Function] = [*self.made.items, *self.made.functions]
        for entry in entries:
            name = to_c(entry.name)
            if name in taken:
                raise self.wrong(entry.at, f"{taken[name]!r} and {entry.name!r} are both {name!r} in C")
            taken[name] = entry.name

    def _check_hal_names(self) -> None:
        """No two may have one name in the HAL; those that exist for different personalities may."""
        for (one, first), (other, second) in combinations(_hal_names(self.made), 2):
            same = one == other and not (first.condition and second.condition and first.condition != second.condition)
            if same and first is not second:
                later = max(first, second, key=lambda item: item.at)
                raise self.wrong(later.at, f"{first.name!r} and {second.name!r} both export the HAL name {one!r}")
        functions = [to_hal(function.name) for function in self.made.functions]
        for i, function in enumerate(self.made.functions):
            if functions[i] in functions[:i]:
                raise self.wrong(function.at, f"two functions export the HAL name {functions[i]!r}")


def _hal_names(made: Component) -> list[tuple[str, Item]]:
    """Every name of a pin or parameter with what it comes from; functions bring three each."""
    found = []
    for item in made.items:
        pattern = to_hal(item.name)
        found += [(pattern % i, item) for i in range(item.size)] if item.size else [(pattern, item)]
    for function in made.functions:
        start = f"{to_hal(function.name)}." if to_hal(function.name) else ""
        for word in ("time", "tmax", "tmax-increased"):
            found.append((start + word, Item(True, "HAL_OUT", "s32", f"{function.name}.{word}", function.at)))
    return found

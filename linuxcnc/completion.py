"""Completion for bash, zsh and fish, made from a command's own parser, so that it knows what the command knows.

The command has orders, each with options of its own, as ``linuxcnc-ctl``; where an order takes a FILE, files complete.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

_BASH = """\
{function}() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}" order="" at
    for ((at = 1; at < COMP_CWORD; at++)); do
        case "${{COMP_WORDS[at]}}" in
            {with_value}) ((at++)) ;;
            -*) ;;
            *) order="${{COMP_WORDS[at]}}"; break ;;
        esac
    done
    COMPREPLY=()
    case "$order" in
        "") COMPREPLY=($(compgen -W "{options} {orders}" -- "$word")) ;;
{cases}
    esac
}}
complete -F {function} {program}"""
_BASH_CASE = """\
        {order}) COMPREPLY=($(compgen -W "{words}" -- "$word"){files}) ;;"""
_BASH_FILES = """ $(compgen -f -- "$word")"""

_ZSH = """\
#compdef {program}
{function}() {{
    local order="" at
    for ((at = 2; at < CURRENT; at++)); do
        case "${{words[at]}}" in
            {with_value}) ((at++)) ;;
            -*) ;;
            *) order="${{words[at]}}"; break ;;
        esac
    done
    case "$order" in
        "") local -a orders=({orders}); _describe order orders; compadd -- {options} ;;
{cases}
    esac
}}
compdef {function} {program}"""
_ZSH_CASE = """\
        {order}) {files}compadd -- {words} ;;"""

_FISH_ORDER = """\
function {function}_order
    set -l words (commandline -opc)
    while set -e words[1]; and set -q words[1]
        switch $words[1]
            case {with_value}
                set -e words[1]
            case '-*'
            case '*'
                echo $words[1]
                return
        end
    end
end"""


def _bash(parser: argparse.ArgumentParser) -> str:
    orders = _orders(parser)
    return _BASH.format(
        function=_function(parser),
        program=parser.prog,
        with_value="|".join(_with_value(parser)),
        options=" ".join(_options(parser)),
        orders=" ".join(orders),
        cases="\n".join(
            _BASH_CASE.format(order=name, words=" ".join(_words(one)), files=_BASH_FILES if _takes_file(one) else "")
            for name, one in orders.items()
        ),
    )


def _zsh(parser: argparse.ArgumentParser) -> str:
    orders = _orders(parser)
    return _ZSH.format(
        function=_function(parser),
        program=parser.prog,
        with_value="|".join(_with_value(parser)),
        options=" ".join(_options(parser)),
        orders=" ".join(_quoted(f"{name}:{(one.description or '').replace(':', ' ')}") for name, one in orders.items()),
        cases="\n".join(
            _ZSH_CASE.format(order=name, words=" ".join(_words(one)), files="_files; " if _takes_file(one) else "")
            for name, one in orders.items()
        ),
    )


def _fish(parser: argparse.ArgumentParser) -> str:
    program, orders, ask = parser.prog, _orders(parser), f"({_function(parser)}_order)"
    lines = [_FISH_ORDER.format(function=_function(parser), with_value=" ".join(_with_value(parser)))]
    lines.append(f"complete -c {program} -f")
    none_yet = _quoted(f"not string length -q -- {ask}")
    lines += _fish_options(program, parser, none_yet)
    for name, one in orders.items():
        lines.append(f"complete -c {program} -n {none_yet} -a {name} -d {_quoted(one.description or '')}")
        here = _quoted(f"string match -q {name} -- {ask}")
        lines += _fish_options(program, one, here)
        if choices := [word for word in _words(one) if not word.startswith("-")]:
            lines.append(f"complete -c {program} -n {here} -a {_quoted(' '.join(choices))}")
        if _takes_file(one):
            lines.append(f"complete -c {program} -n {here} -F")
    return "\n".join(lines)


def _fish_options(program: str, parser: argparse.ArgumentParser, condition: str) -> list[str]:
    return [
        f"complete -c {program} -n {condition} -l {word[2:]}{' -x' if action.nargs != 0 else ''} "
        f"-d {_quoted(action.help or '')}"
        for action in parser._actions
        for word in action.option_strings
        if word.startswith("--")
    ]


SHELLS: dict[str, Callable[[argparse.ArgumentParser], str]] = {"bash": _bash, "zsh": _zsh, "fish": _fish}


def _function(parser: argparse.ArgumentParser) -> str:
    return f"_{parser.prog.replace('-', '_')}"


def _orders(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    subparsers = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    orders: dict[str, argparse.ArgumentParser] = subparsers.choices
    return orders


def _with_value(parser: argparse.ArgumentParser) -> list[str]:
    return [word for action in parser._actions if action.nargs != 0 for word in action.option_strings]


def _options(parser: argparse.ArgumentParser) -> list[str]:
    return [word for action in parser._actions for word in action.option_strings if word.startswith("--")]


def _words(parser: argparse.ArgumentParser) -> list[str]:
    """The options of an order, and what its argument may be."""
    choices = [str(word) for action in parser._actions if not action.option_strings for word in action.choices or ()]
    return [*choices, *_options(parser)]


def _takes_file(parser: argparse.ArgumentParser) -> bool:
    return any(not action.option_strings and action.metavar == "FILE" for action in parser._actions)


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"

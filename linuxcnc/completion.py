"""Completion for bash, made from a command's own parser, so that it knows what the command knows."""

from __future__ import annotations

import argparse

_FUNCTION = """\
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
_CASE = """\
        {order}) COMPREPLY=($(compgen -W "{words}" -- "$word"){files}) ;;"""
_FILES = """ $(compgen -f -- "$word")"""


def bash_completion(parser: argparse.ArgumentParser) -> str:
    """A script for bash that completes orders, their options, and files where an order takes one."""
    subparsers = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    orders: dict[str, argparse.ArgumentParser] = subparsers.choices
    with_value = [word for action in parser._actions if action.nargs != 0 for word in action.option_strings]
    return _FUNCTION.format(
        function=f"_{parser.prog.replace('-', '_')}",
        program=parser.prog,
        with_value="|".join(with_value),
        options=" ".join(_options(parser)),
        orders=" ".join(orders),
        cases="\n".join(
            _CASE.format(order=name, words=" ".join(_options(one)), files=_FILES if _takes_file(one) else "")
            for name, one in orders.items()
        ),
    )


def _options(parser: argparse.ArgumentParser) -> list[str]:
    return [word for action in parser._actions for word in action.option_strings if word.startswith("--")]


def _takes_file(parser: argparse.ArgumentParser) -> bool:
    return any(not action.option_strings and action.metavar == "FILE" for action in parser._actions)

"""The .comp language: names, declarations, and what is said about mistakes."""

from __future__ import annotations

import pytest

from hal.halcompile import language, manpage, source
from hal.halcompile.language import CompError, to_c, to_hal

HEAD = 'component part "A part";\nlicense "GPL";\n'


def read(declarations: str, code: str = "") -> language.Component:
    return language.read("part.comp", f"{HEAD}{declarations}\n;;\n{code}")


@pytest.mark.parametrize(
    ("name", "in_c", "in_hal"),
    [
        ("x_y_z", "x_y_z", "x-y-z"),
        ("x-y.z", "x_y_z", "x-y.z"),
        ("x_y_z_", "x_y_z_", "x-y-z"),
        ("x.##.y", "x_y", "x.%02d.y"),
        ("x.##", "x", "x.%02d"),
        ("_", "_", ""),
    ],
)
def test_a_name_is_one_thing_in_c_and_another_in_the_hal(name: str, in_c: str, in_hal: str) -> None:
    assert (to_c(name), to_hal(name)) == (in_c, in_hal)


def test_pins_take_sizes_conditions_values_and_texts_in_this_order() -> None:
    made = read(
        'pin in float in-##[16 : personality & 0xff] if (personality >> 8) == 1 = -1.5 "an \\"input\\"";\n'
        'param rw unsigned mask = 0x10 r"""two\nlines \\fIx""";'
    )
    first, second = made.items
    assert (first.type, first.size, first.how_many) == ("float", 16, "personality & 0xff")
    assert (first.condition, first.value, first.doc) == ("( personality >> 8 ) == 1", "- 1.5", 'an "input"')
    assert (second.is_pin, second.type, second.value, second.doc) == (False, "u32", "0x10", "two\nlines \\fIx")
    assert made.has_personality


def test_comments_variables_options_and_headers_are_read() -> None:
    made = read(
        "// a line\n/* several\nlines */ variable unsigned long *where[4] = 3;\n"
        'include <math.h>; include "mine.h";\noption singleton; option default_count 3; function _ nofp "works";'
    )
    assert [(v.type, v.stars, v.name, v.size, v.value) for v in made.variables] == [
        ("unsigned long", "*", "where", "4", "3")
    ]
    assert made.includes == ["<math.h>", '"mine.h"']
    assert made.option("singleton")
    assert made.options["default_count"] == "3"
    assert (made.functions[0].uses_fp, made.functions[0].doc) == (False, "works")


@pytest.mark.parametrize(
    ("declarations", "place", "what"),
    [
        ("pin out bit a_b;\npin in bit a_b_;", "4:12", "'a_b' and 'a_b_' both export the HAL name 'a-b'"),
        ("pin in s32 a_##[2];\npin in bit a-01;", "4:12", "'a_##' and 'a-01' both export the HAL name 'a-01'"),
        ("pin out bit up.time;\nfunction up;", "4:10", "'up.time' and 'up.time' both export"),
        ("pin out bit a;\nparam r bit a;", "4:13", "'a' and 'a' are both 'a' in C"),
        ("pin sideways bit a;", "3:5", "'sideways' is no direction of a pin: in, out, io"),
        ("pin in byte a;", "3:8", "'byte' is no type: bit, "),
        ("pin in bit a[3];", "3:12", "'#' in the name and [SIZE] behind it belong together"),
        ("pin in bit a-#[300];", "3:12", "an array of 300: up to 256 are possible"),
        ("option fast;", "3:8", "'fast' is no option"),
        ("option homemod;", "3:8", "homing is part of motmod here"),
        ("option userspace;\nfunction _;", "4:10", "a userspace component has no functions"),
        ("pins in bit a;", "3:1", "'pins' is no declaration: component, pin"),
        ("pin in bit a", "4:1", "';' is expected here"),
        ("@", "3:1", "'@' belongs to no declaration"),
    ],
)
def test_a_mistake_is_named_with_its_place(declarations: str, place: str, what: str) -> None:
    with pytest.raises(CompError) as caught:
        read(declarations)
    lines = str(caught.value).splitlines()
    assert lines[0].startswith(f"part.comp:{place}: ")
    assert what in lines[0]
    assert lines[2].index("^") - 3 == int(place.partition(":")[2]) - 1


def test_pins_of_different_personalities_may_share_a_name() -> None:
    made = read("pin out bit a_ if personality == 1;\npin out float a if personality == 2;")
    assert [to_hal(item.name) for item in made.items] == ["a", "a"]


def test_a_file_needs_a_name_a_license_and_a_divider() -> None:
    for text, what in (
        ("component a;\n", "no line with ';;'"),
        ("component a;\n;;\n", "no declaration 'license"),
        ("license \"GPL\";\n;;\n", "the first declaration must be 'component NAME;'"),
    ):
        with pytest.raises(CompError, match=what):
            language.read("a.comp", text)


def test_code_without_functions_named_is_the_body_of_the_only_one() -> None:
    text = source.generate(read("pin out bit a;\nfunction _;", "a = 1;\n"), 64)
    assert 'FUNCTION(_) {\n#line 6 "part.comp"\na = 1;' in text
    named = read("pin out bit a;\nfunction _;", "FUNCTION(_) { a = 1; }")
    assert "FUNCTION(_) {\n#line" not in source.generate(named, 64)


def test_the_manual_page_shows_names_types_and_texts() -> None:
    page = manpage.generate(read('pin out bit out-##[4] = 1 "four of them";\nparam rw s32 n;\ndescription "Long.";'))
    assert ".B loadrt part [count=" in page
    assert ".B part.\\fIN\\fB.out-\\fIMM\\fB \\fRbit out (MM=0..3) (default: 1)\nfour of them" in page
    assert ".SH PARAMETERS" in page
    assert ".SH DESCRIPTION\nLong." in page

"""The C of a .comp file: the structure of an instance, what makes instances, macros for names, and the author's code.

What it calls is in ``hal/include``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass

from hal.halcompile.language import Component, Function, Item, Variable, to_c, to_hal

MOST_INSTANCE_NAMES = 16

HEAD = """\
/* Made by halcompile from {file}. */
#include "rtapi.h"
#include "rtapi_app.h"
#include "rtapi_errno.h"
#include "rtapi_string.h"
#include "hal.h"
#include <string.h>
"""

MAIN = """
int rtapi_app_main(void)
{{
    int r = 0;
    comp_id = hal_init("{name}");
    if (comp_id < 0)
        return comp_id;
{instances}
    if (r == 0)
        r = hal_ready(comp_id);
    if (r != 0) {{
{cleanup}        hal_exit(comp_id);
    }}
    return r;
}}

void rtapi_app_exit(void)
{{
{cleanup}    hal_exit(comp_id);
}}
"""

NUMBERED = """\
    for (int i = 0; i < {count} && r == 0; i++) {{
        char prefix[HAL_NAME_LEN + 1];
        rtapi_snprintf(prefix, sizeof(prefix), "{prefix}.%d", i);
        r = export(prefix, i{personality});
    }}
"""

COUNT_OR_NAMES = """\
    if (count && names[0]) {{
        rtapi_print_msg(RTAPI_MSG_ERR, "{name}: count= and names= cannot be given together\\n");
        hal_exit(comp_id);
        return -EINVAL;
    }}
    for (int i = 0; i < {most} && names[i] && r == 0; i++)
        r = export(names[i], i{personality});
    int numbered = names[0] ? 0 : count ? count : {default};
"""

PROGRAM = """
int main(int argc, char **argv)
{{
    int kept = 0, r;
    for (int i = 0; i < argc; i++) {{
        if (i > 0 && strncmp(argv[i], "count=", 6) == 0)
            count = atoi(argv[i] + 6);
        else if (i > 0 && strncmp(argv[i], "names=", 6) == 0)
            split_names(argv[i] + 6);
        else
            argv[kept++] = argv[i];
    }}
    argv[kept] = NULL;
{userinit}    r = rtapi_app_main();
    if (r < 0)
        return 1;
    user_mainloop();
    rtapi_app_exit();
    return 0;
}}
"""

SPLIT_NAMES = """
static void split_names(char *text)
{{
    int n = 0;
    for (char *word = strtok(text, ","); word && n < {most}; word = strtok(NULL, ","))
        names[n++] = word;
}}
"""


def generate(made: Component, personalities: int) -> str:
    """The C source; as many ``personalities`` may be given to ``loadrt``."""
    return "".join(_Writer(made, personalities).parts())


@dataclass
class _Writer:
    made: Component
    personalities: int

    def parts(self) -> Iterator[str]:
        made = self.made
        yield HEAD.format(file=made.file)
        yield "".join(f"#include {header}\n" for header in made.includes)
        yield "\nstatic int comp_id;\n"
        yield self.structure()
        yield self.prototypes()
        yield self.parameters()
        yield self.export()
        if made.option("rtapi_app"):
            yield self.main()
        if made.option("userspace"):
            yield self.program()
        yield self.macros()
        yield self.code()

    @property
    def counted(self) -> bool:
        """Whether ``count=`` or ``names=`` say which instances there are."""
        return not self.made.option("singleton") and not self.made.option("count_function")

    @property
    def variables(self) -> list[Variable]:
        data = self.made.options.get("data")
        return [*self.made.variables, *([Variable(data, "_data")] if data else [])]

    def structure(self) -> str:
        rows = ["struct __comp_state *_next;", "int _personality;"]
        for item in self.made.items:
            star = "*" if item.is_pin else ""
            rows.append(f"hal_{item.type}_t {star}{to_c(item.name)}{f'[{item.size}]' if item.size else ''};")
        for variable in self.variables:
            size = f"[{variable.size}]" if variable.size else ""
            rows.append(f"{variable.type} {variable.stars}{variable.name}{size};")
        return "\nstruct __comp_state {\n" + "".join(f"    {row}\n" for row in rows) + "};\n"

    def prototypes(self) -> str:
        made = self.made
        rows = ["static struct __comp_state *__comp_first_inst, *__comp_last_inst;"]
        rows += [f"static void {to_c(f.name)}(struct __comp_state *__comp_inst, long period);" for f in made.functions]
        if made.option("extra_setup"):
            rows.append("static int extra_setup(struct __comp_state *__comp_inst, char *prefix, long extra_arg);")
        if made.option("post_export"):
            rows.append("static int post_export(struct __comp_state *__comp_inst, char *prefix, long extra_arg);")
        if made.option("extra_cleanup"):
            rows.append("static void extra_cleanup(void);")
        if made.option("count_function"):
            rows.append("static int get_count(void);")
        if made.option("userspace"):
            rows.append("static void user_mainloop(void);")
        if made.option("userspace") and made.option("userinit"):
            rows.append("static void userinit(int argc, char **argv);")
        return "\n" + "".join(f"{row}\n" for row in rows)

    def parameters(self) -> str:
        text = f"\nMODULE_LICENSE({json.dumps(self.made.texts['license'])});\n"
        realtime = not self.made.option("userspace")
        if self.counted and self.made.option("rtapi_app"):
            text += f"static int count;\nstatic char *names[{MOST_INSTANCE_NAMES}];\n"
            if realtime:
                text += 'RTAPI_MP_INT(count, "how many instances");\n'
                text += f'RTAPI_MP_ARRAY_STRING(names, {MOST_INSTANCE_NAMES}, "names of the instances");\n'
        if self.made.has_personality:
            text += f"static int personality[{self.personalities}];\n"
            if realtime:
                text += f'RTAPI_MP_ARRAY_INT(personality, {self.personalities}, "what each instance has");\n'
        return text

    # ---- instances ----

    def export(self) -> str:
        made = self.made
        extra = ", long personality" if made.has_personality else ""
        rows = ["int r;", "struct __comp_state *inst = hal_malloc(sizeof(struct __comp_state));"]
        rows += ["if (!inst)", "    return -ENOMEM;", "memset(inst, 0, sizeof(*inst));"]
        if made.has_personality:
            rows.append("inst->_personality = personality;")
        rows += [row for variable in self.variables if variable.value for row in _initial(variable)]
        if made.option("extra_setup"):
            rows += ["r = extra_setup(inst, prefix, extra_arg);", "if (r != 0)", "    return r;"]
            rows += ["personality = inst->_personality;"] if made.has_personality else []
        for item in made.items:
            rows += _exported(item)
        for function in made.functions:
            rows += _exported_function(function)
        rows += ["*(__comp_last_inst ? &__comp_last_inst->_next : &__comp_first_inst) = inst;"]
        rows += ["__comp_last_inst = inst;", "(void)r;"]
        rows.append("return post_export(inst, prefix, extra_arg);" if made.option("post_export") else "return 0;")
        body = "".join(f"    {row}\n" for row in rows)
        return f"\nstatic int export(char *prefix, long extra_arg{extra})\n{{\n{body}}}\n"

    def main(self) -> str:
        made = self.made
        cleanup = "    extra_cleanup();\n" if made.option("extra_cleanup") else ""
        return MAIN.format(name=made.name, instances=self.instances().rstrip("\n"), cleanup=cleanup)

    def instances(self) -> str:
        made, prefix = self.made, self.made.hal_name
        personality = f", personality[i % {self.personalities}]" if made.has_personality else ""
        if made.option("singleton"):
            return f'    r = export("{prefix}", 0{", personality[0]" if made.has_personality else ""});\n'
        if made.option("count_function"):
            return NUMBERED.format(count="get_count()", prefix=prefix, personality=personality)
        before = COUNT_OR_NAMES.format(
            name=made.name, most=MOST_INSTANCE_NAMES, personality=personality,
            default=made.options.get("default_count", "1"),
        )  # fmt: skip
        return before + NUMBERED.format(count="numbered", prefix=prefix, personality=personality)

    def program(self) -> str:
        init = "    userinit(kept, argv);\n" if self.made.option("userinit") else ""
        return SPLIT_NAMES.format(most=MOST_INSTANCE_NAMES) + PROGRAM.format(userinit=init)

    # ---- the author's part ----

    def macros(self) -> str:
        names = ["FUNCTION", "EXTRA_SETUP", "POST_EXPORT", "EXTRA_CLEANUP", "fperiod", "FOR_ALL_INSTS"]
        instance = "struct __comp_state *__comp_inst"
        rows = [
            f"#define FUNCTION(name) static void name({instance}, long period)",
            f"#define EXTRA_SETUP() static int extra_setup({instance}, char *prefix, long extra_arg)",
            f"#define POST_EXPORT() static int post_export({instance}, char *prefix, long extra_arg)",
            "#define EXTRA_CLEANUP() static void extra_cleanup(void)",
            "#define fperiod (period * 1e-9)",
            f"#define FOR_ALL_INSTS() for ({instance} = __comp_first_inst; __comp_inst; "
            "__comp_inst = __comp_inst->_next)",
        ]
        if self.made.has_personality:
            names.append("personality")
            rows.append("#define personality (__comp_inst->_personality)")
        for item in self.made.items:
            names.append(to_c(item.name))
            rows.append(_macro(item))
            if item.set_by_call:
                names.append(f"{to_c(item.name)}_set")
                rows.append(_setter(item))
        for variable in self.made.variables:
            names.append(variable.name)
            rows.append(f"#define {variable.name} (__comp_inst->{variable.name})")
        if "data" in self.made.options:
            names.append("data")
            rows.append("#define data (__comp_inst->_data)")
        return "\n" + "".join(f"#undef {name}\n" for name in names) + "".join(f"{row}\n" for row in rows)

    def code(self) -> str:
        made = self.made
        line = f"\n#line {made.code_line} {json.dumps(made.file)}\n"
        if len(made.functions) == 1 and "FUNCTION" not in made.code:
            return f"\nFUNCTION({to_c(made.functions[0].name)}) {{{line}{made.code}\n}}\n"
        return line + made.code


def _macro(item: Item) -> str:
    name = to_c(item.name)
    place = f"__comp_inst->{name}[i]" if item.size else f"__comp_inst->{name}"
    value = f"*({place})" if item.is_pin else place
    only_read = item.is_pin and item.direction == "HAL_IN"
    return f"#define {name}{'(i)' if item.size else ''} ({'0 + ' if only_read else ''}{value})"


def _setter(item: Item) -> str:
    name = to_c(item.name)
    arguments, place = ("i, value", f"{name}(i)") if item.size else ("value", name)
    return f"#define {name}_set({arguments}) ({place} = (value))"


def _initial(variable: Variable) -> list[str]:
    if not variable.size:
        return [f"inst->{variable.name} = {variable.value};"]
    return [f"for (int j = 0; j < ({variable.size}); j++)", f"    inst->{variable.name}[j] = {variable.value};"]


def _exported(item: Item) -> list[str]:
    """C that makes a pin or parameter, or the items of an array."""
    kind, name, index = ("pin" if item.is_pin else "param"), to_c(item.name), "[j]" if item.size else ""
    pattern, number = to_hal(item.name), ", j" if item.size else ""
    place = f"inst->{name}{index}"
    call = f'r = hal_{kind}_{item.type}_newf({item.direction}, &({place}), comp_id, "%s.{pattern}", prefix{number});'
    rows = [call, "if (r != 0)", "    return r;"]
    if item.is_pin or item.value:
        rows.append(f"{'*' if item.is_pin else ''}({place}) = {item.value or '0'};")
    if item.size:
        rows = [f"for (int j = 0; j < ({item.how_many or item.size}); j++) {{", *_indented(rows), "}"]
        if item.how_many:
            most = [f"if (({item.how_many}) > {item.size}) {{"]
            most.append(
                f'    rtapi_print_msg(RTAPI_MSG_ERR, "%s: %d items of {item.name}; up to {item.size} are possible\\n", '
                f"prefix, (int)({item.how_many}));"
            )
            rows = [*most, "    return -EINVAL;", "}", *rows]
    return [f"if ({item.condition}) {{", *_indented(rows), "}"] if item.condition else rows


def _exported_function(function: Function) -> list[str]:
    hal_name = to_hal(function.name)
    pattern = f"%s.{hal_name}" if hal_name else "%s"
    code = f"(hal_host_code){to_c(function.name)}"
    call = f'r = hal_export_functf({code}, inst, {int(function.uses_fp)}, 0, comp_id, "{pattern}", prefix);'
    return [call, "if (r != 0)", "    return r;"]


def _indented(rows: list[str]) -> list[str]:
    return [re.sub("^", "    ", row) for row in rows]

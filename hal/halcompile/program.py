"""The program ``halcompile``: compiles, installs and documents components in the .comp language and in C.

    halcompile [--compile|--install|--preprocess|--document|--install-doc|--view-doc] FILE...
    halcompile --compile|--install --userspace FILE.c|FILE.py

A realtime component becomes NAME.so, which ``loadrt NAME`` finds where --install puts it; another becomes a program.
"""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import zipapp
from pathlib import Path

from hal.finder import modules_folder
from hal.halcompile import language, manpage, source
from nml.errors import HalError, PyemcError

INCLUDE = Path(__file__).resolve().parent.parent / "include"
COMPILER_VARIABLE = "CC"
FLAGS = ("-O2", "-g", "-fPIC", "-shared", "-fno-math-errno", "-ffp-contract=off", "-std=gnu11", "-Wno-unused-function")
RUNNER = """\
import os, sys, zipfile
from hal.native import run

program = sys.argv[0]
with os.fdopen(os.memfd_create("component"), "wb", buffering=0) as file:
    file.write(zipfile.ZipFile(program).read("component.so"))
    sys.exit(run(f"/proc/self/fd/{file.fileno()}", [os.path.basename(program), *sys.argv[1:]]))
"""


def main() -> int:
    options = _options()
    try:
        for file in options.files:
            ACTIONS[options.action](Path(file), options)
    except subprocess.CalledProcessError as error:
        return error.returncode or 1
    except OSError as error:
        print(f"halcompile: {error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    except PyemcError as error:
        print(error if isinstance(error, language.CompError) else f"halcompile: {error}", file=sys.stderr)
        return 1
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="halcompile", description="Compile, install and document HAL components.")
    action = parser.add_mutually_exclusive_group()
    for letter, name, doc in (
        ("-i", "install", "compile, and install where loadrt and loadusr look"),
        ("-c", "compile", "leave the module, or the program, in the current folder"),
        ("-p", "preprocess", "leave the C source beside the .comp file (what is done where nothing is asked for)"),
        ("-d", "document", "leave the manual page beside the .comp file"),
        ("-j", "install-doc", "install the manual page"),
        ("-v", "view-doc", "show the manual page"),
        ("-l", "license", "print the license that the file declares"),
    ):
        action.add_argument(letter, f"--{name}", dest="action", action="store_const", const=name, help=doc)
    action.add_argument("--print-modinc", action=_PrintFlags, help="print the folder of the headers")
    parser.add_argument("-u", "--userspace", action="store_true", help="the files are programs in C or Python")
    parser.add_argument("-o", "--outfile", help="where --preprocess and --document write")
    parser.add_argument("-P", "--personalities", "--personality", type=int, default=64, help="how many there may be")
    parser.add_argument("--extra-compile-args", default="", help="for the compiler")
    parser.add_argument("--extra-link-args", default="", help="for the linker")
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.set_defaults(action="preprocess")
    options = parser.parse_args()
    if options.outfile and len(options.files) > 1:
        parser.error("--outfile goes with one file only")
    if options.personalities < 1:
        parser.error(f"--personalities={options.personalities}: from 1 would be right")
    return options


class _PrintFlags(argparse.Action):
    def __init__(self, option_strings: list[str], dest: str, **more: object) -> None:
        super().__init__(option_strings, dest, nargs=0, help=str(more.get("help")))

    def __call__(self, *_: object) -> None:
        print(INCLUDE)
        raise SystemExit(0)


def read(path: Path) -> language.Component:
    """The component of a .comp file, which must have the file's name."""
    if path.suffix != ".comp":
        raise HalError(f"{path}: a .comp file would be right here")
    made = language.read(str(path), path.read_text())
    if made.name != path.stem:
        raise HalError(f"{path}: component name ({made.name}) does not match filename ({path.stem})")
    return made


# ---- compiling ----


def _compile(path: Path, options: argparse.Namespace, folder: Path) -> tuple[Path, bool]:
    """The library of a .comp or .c file, made in ``folder``, and whether it is a program's."""
    userspace, extra = options.userspace, [options.extra_compile_args, options.extra_link_args]
    if path.suffix == ".comp":
        made = read(path)
        userspace = made.option("userspace")
        if userspace:
            extra = [made.options.get("extra_compile_args", ""), made.options.get("extra_link_args", "")]
        text = folder / f"{path.stem}.c"
        text.write_text(source.generate(made, options.personalities))
    elif path.suffix == ".c":
        text = path
    else:
        raise HalError(f"{path}: a .comp or .c file would be right here")
    library = folder / f"{path.stem}.so"
    compiler = shlex.split(os.environ.get(COMPILER_VARIABLE, "gcc"))
    if shutil.which(compiler[0]) is None:
        raise HalError(f"the compiler '{compiler[0]}' is not installed; Debian's package gcc has it")
    places = [f"-I{INCLUDE}", f"-I{path.resolve().parent}"]
    words = [*compiler, *FLAGS, *places, *shlex.split(extra[0]), str(text), "-o", str(library), *shlex.split(extra[1])]
    subprocess.run([*words, "-Wl,-z,defs", "-lm"], check=True)
    return library, userspace


def _program(library: Path, target: Path) -> None:
    """A program of one file, which runs the library's ``main``."""
    folder = library.parent / "program"
    folder.mkdir()
    (folder / "__main__.py").write_text(RUNNER)
    shutil.copy(library, folder / "component.so")
    zipapp.create_archive(folder, target, interpreter=sys.executable)


def _place(path: Path, options: argparse.Namespace, modules: Path, programs: Path) -> None:
    if path.suffix == ".py":
        if not options.userspace:
            raise HalError(f"{path}: a Python program is installed with --userspace")
        shutil.copy(path, programs / path.stem)
        (programs / path.stem).chmod(0o755)
        return
    with tempfile.TemporaryDirectory() as folder:
        library, userspace = _compile(path, options, Path(folder))
        if userspace:
            _program(library, programs / path.stem)
        else:
            modules.mkdir(parents=True, exist_ok=True)
            target = modules / f"{path.stem}.so"
            fresh = target.with_suffix(".new")
            shutil.copyfile(library, fresh)
            fresh.chmod(0o644)
            fresh.replace(target)  # a host that has the old one loaded keeps it


def compile_(path: Path, options: argparse.Namespace) -> None:
    _place(path, options, Path.cwd(), Path.cwd())


def install(path: Path, options: argparse.Namespace) -> None:
    _place(path, options, modules_folder(), Path(sys.executable).parent)
    if path.suffix == ".comp":
        install_doc(path, options)


def preprocess(path: Path, options: argparse.Namespace) -> None:
    made = read(path)
    Path(options.outfile or path.with_suffix(".c")).write_text(source.generate(made, options.personalities))


# ---- documenting ----


def _section(made: language.Component) -> str:
    return "1" if made.option("userspace") else "9"


def document(path: Path, options: argparse.Namespace) -> None:
    made = read(path)
    Path(options.outfile or path.with_suffix(f".{_section(made)}")).write_text(manpage.generate(made))


def install_doc(path: Path, options: argparse.Namespace) -> None:
    made = read(path)
    folder = Path(sys.prefix, "share", "man", f"man{_section(made)}")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{made.name}.{_section(made)}").write_text(manpage.generate(made))


def view_doc(path: Path, options: argparse.Namespace) -> None:
    made = read(path)
    if shutil.which("man") is None:
        print(manpage.generate(made), end="")
        return
    with tempfile.NamedTemporaryFile("w", suffix=f".{_section(made)}") as file:
        file.write(manpage.generate(made))
        file.flush()
        subprocess.run(["man", file.name], check=True)


def license_(path: Path, options: argparse.Namespace) -> None:
    print(read(path).texts["license"])


ACTIONS = {
    "install": install, "compile": compile_, "preprocess": preprocess, "document": document,
    "install-doc": install_doc, "view-doc": view_doc, "license": license_,
}  # fmt: skip

if __name__ == "__main__":
    sys.exit(main())

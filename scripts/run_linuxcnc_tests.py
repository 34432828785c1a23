#!/usr/bin/env python3
"""Run the folders of LinuxCNC's own test suite against these programs: run_linuxcnc_tests.py TESTS [PART ...]

TESTS is the suite's folder ``tests``; PART takes only the folders whose path has it. See docs/linuxcnc-suite.md.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ["bash", "-c", '"$@"', "bash"]
"""Before a program and its arguments: a shell also runs what is executable and names no interpreter."""

COMMANDS = {
    "test.hal": ["halrun", "-f", "test.hal"],
    "test.sh": ["bash", "-x", "test.sh"],
    "test": [*PROGRAM, "./test"],
}
HEADERS = "/usr/include/linuxcnc"
GRACE_S = 5.0  # between SIGTERM and SIGKILL


@dataclass(frozen=True)
class Outcome:
    """What became of one folder: ``pass``, ``fail``, ``skip`` or ``xfail``, and why."""

    word: str
    why: str = ""


def cases(suite: Path, parts: list[str]) -> list[Path]:
    """Folders with a test, relative to the suite, in order."""
    found = {path.parent.relative_to(suite) for name in COMMANDS for path in suite.rglob(name) if path.is_file()}
    return sorted(case for case in found if not parts or any(part in str(case) for part in parts))


def environment(folder: Path, number: int) -> dict[str, str]:
    """What a test finds: these programs first, a namespace of its own, and the names that LinuxCNC's runner sets."""
    programs = [str(ROOT / ".venv" / "bin"), str(Path(sys.executable).parent)]
    path = [*programs, str(folder), os.environ.get("PATH", "/usr/bin:/bin")]
    python_path = [str(ROOT), os.environ.get("PYTHONPATH", "")]
    own = {
        "PATH": os.pathsep.join(path),
        "PYTHONPATH": os.pathsep.join(filter(None, python_path)),
        "PYEMC_NAMESPACE": f"suite{os.getpid()}-{number}",
        "TEST_DIR": str(folder),
        "HEADERS": HEADERS,
        "REALTIME": "realtime",
        "SUDO": "sudo",
        "LC_ALL": "C",
    }
    inherited = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    return inherited | own


def is_skipped(folder: Path) -> bool:
    """A file ``skip`` skips, unless it is a program that succeeds."""
    skip = folder / "skip"
    if not skip.exists():
        return False
    return not os.access(skip, os.X_OK) or subprocess.run([skip], cwd=folder, check=False).returncode != 0


def end(process: subprocess.Popen[bytes]) -> None:
    """End the test and whatever it left running in its session."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(GRACE_S)


def execute(folder: Path, env: dict[str, str], patience: float) -> str:
    """Run the test into the files ``result`` and ``stderr``: why it failed, or nothing."""
    command = next(COMMANDS[name] for name in COMMANDS if (folder / name).is_file())
    with (folder / "result").open("wb") as result, (folder / "stderr").open("wb") as errors:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=result,
            stderr=errors,
            start_new_session=True,
        )
        try:
            code = process.wait(patience)
        except subprocess.TimeoutExpired:
            return f"not over within {patience:g} s"
        finally:
            end(process)
    return f"exit code {code}" if code else ""


def judged(folder: Path, env: dict[str, str]) -> str:
    """Compare the result: why it is wrong, or nothing."""
    if (folder / "checkresult").exists():
        before = PROGRAM if os.access(folder / "checkresult", os.X_OK) else ["bash"]
        command = [*before, "./checkresult", str(folder / "result")]
        done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)
        return f"checkresult: exit code {done.returncode}\n{done.stdout}{done.stderr}" if done.returncode else ""
    if not (folder / "expected").exists():
        return "neither expected nor checkresult is there"
    done = subprocess.run(["diff", "-u", "expected", "result"], cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout


def run(folder: Path, number: int, patience: float) -> Outcome:
    """One folder."""
    if is_skipped(folder):
        return Outcome("skip")
    env = environment(folder, number)
    why = execute(folder, env, patience) or judged(folder, env)
    if not why:
        return Outcome("pass")
    return Outcome("xfail" if (folder / "xfail").exists() else "fail", why)


def main(arguments: list[str] | None = None) -> int:
    """Run them all: 0 when none failed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("suite", type=Path, metavar="TESTS")
    parser.add_argument("parts", nargs="*", metavar="PART")
    parser.add_argument("--timeout", type=float, default=180.0, metavar="SECONDS", help="for one folder (180)")
    options = parser.parse_args(arguments)
    if not options.suite.is_dir():
        parser.error(f"{options.suite}: there is no such folder")
    count: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="linuxcnc-suite-") as work:
        copy = Path(work) / "tests"
        shutil.copytree(options.suite, copy, symlinks=True)
        for number, case in enumerate(cases(copy, options.parts)):
            outcome = run(copy / case, number, options.timeout)
            count[outcome.word] += 1
            print(f"{outcome.word:5} {case}", flush=True)
            if outcome.word == "fail":
                print("".join(f"      {line}\n" for line in outcome.why.splitlines()[:40]), end="", flush=True)
    print(", ".join(f"{count[word]} {word}" for word in ("pass", "fail", "xfail", "skip")))
    return 1 if count["fail"] else 0


if __name__ == "__main__":
    sys.exit(main())

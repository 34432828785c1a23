"""[EMCIO]DB_PROGRAM: a program of the user's that keeps the tools, asked and told over its standard input and output.

Protocol v2.1 of LinuxCNC's manual, chapter 9.10: the program begins with a line ``v2.1``. ``g`` asks for all tools:
lines in the format of a tool table, then one with FINI. ``p LINE`` tells new values, ``l Tn P0`` a loaded spindle,
``u Tn Pm`` an unloaded one; each is answered by a line, and one with NAK is a complaint. Whatever is said after
the start is said in a thread of its own: a program that takes its time never holds up the E-stop chain.
"""

from __future__ import annotations

import ctypes
import queue
import signal
import subprocess
import threading
from pathlib import Path

from emcio.toolstore import ToolStore
from emcio.tooltable import Tool, format_line, parse_line
from nml.errors import ConfigError

VERSION = "v2.1"
ALL, END, REFUSAL = "g", "FINI", "NAK"
PR_SET_PDEATHSIG = 1  # of <linux/prctl.h>
ANSWER_S = 5.0  # host time that the program has for an answer


def _end_with_parent() -> None:
    """In the new process: SIGTERM when io dies, for a program may not notice that nobody asks any more."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class DatabaseTools:
    """A running data base program. ConfigError when it cannot be started or speaks another version."""

    def __init__(self, command: list[str], folder: Path) -> None:
        try:
            self._process = subprocess.Popen(
                command,
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                bufsize=1,
                preexec_fn=_end_with_parent,
            )
        except OSError as error:
            raise ConfigError(f"[EMCIO]DB_PROGRAM = {command[0]}: {error.strerror}") from None
        self._talk = threading.Lock()
        self._failure: str | None = None
        self._fresh: tuple[list[Tool], list[str]] | None = None
        self._orders: queue.Queue[str | None] = queue.Queue()
        self._lines: queue.Queue[str | None] = queue.Queue()
        self._reader = threading.Thread(target=self._read, name="tool data base answers", daemon=True)
        self._reader.start()
        version = self._line()
        if version != VERSION:
            self._process.kill()
            self._process.wait()
            raise ConfigError(f"[EMCIO]DB_PROGRAM = {command[0]} speaks {version!r}; {VERSION!r} is needed")
        self._thread = threading.Thread(target=self._run, name="tool data base", daemon=True)
        self._thread.start()

    def load(self, store: ToolStore, path: str = "") -> list[str]:
        """Ask for all tools and wait for the answer."""
        tools, remarks = self._all_tools()
        return remarks + store.load(tools)

    def reload(self, store: ToolStore, path: str = "") -> list[str]:
        """Ask for all tools; ``arrived`` takes them over when the program has answered."""
        self._orders.put(ALL)
        return []

    def arrived(self, store: ToolStore) -> list[str] | None:
        """Take over the answer to ``reload``; None if there is none yet."""
        fresh, self._fresh = self._fresh, None
        if fresh is None:
            return None
        tools, remarks = fresh
        return remarks + store.load(tools)

    def _all_tools(self) -> tuple[list[Tool], list[str]]:
        remarks: list[str] = []
        tools: list[Tool] = []
        with self._talk:
            self._say(ALL)
            while not (line := self._line()).startswith(END):
                if line.startswith(REFUSAL):
                    raise ConfigError(f"the tool data base refused to list its tools: {line}")
                try:
                    tool = parse_line(line)
                except ConfigError as error:
                    remarks.append(f"tool data base: {line!r}: {error.message}")
                    continue
                if tool is not None:
                    tools.append(tool)
        return tools, remarks

    def save(self, store: ToolStore) -> None:
        """The program keeps what ``put`` and ``spindle`` told it."""

    def put(self, tool: Tool) -> None:
        """Tell one tool's new values."""
        self._orders.put(f"p {format_line(tool)}")

    def spindle(self, letter: str, toolno: int, pocket: int) -> None:
        """Tell that a tool went into the spindle or left it."""
        self._orders.put(f"{letter} T{toolno} P{pocket}")

    @property
    def busy(self) -> bool:
        """Is there something left to tell?"""
        return bool(self._orders.unfinished_tasks) or self._fresh is not None

    def failure(self) -> str | None:
        """What the program complained of, told once."""
        failure, self._failure = self._failure, None
        return failure

    def close(self) -> None:
        """Tell the rest, then end the program."""
        self._orders.put(None)
        self._thread.join(ANSWER_S)
        self._process.terminate()
        self._process.wait()
        self._reader.join(ANSWER_S)
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()

    def _run(self) -> None:
        while (order := self._orders.get()) is not None:
            try:
                if order == ALL:
                    self._fresh = self._all_tools()
                else:
                    self._tell(order)
            except ConfigError as error:
                self._failure = error.message
            finally:
                self._orders.task_done()

    def _tell(self, order: str) -> None:
        with self._talk:
            self._say(order)
            answer = self._line()
        if REFUSAL in answer:
            self._failure = f"the tool data base refused {order!r}: {answer}"

    def _say(self, text: str) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(text + "\n")
            self._process.stdin.flush()
        except OSError:
            raise ConfigError("the tool data base program has ended") from None

    def _line(self) -> str:
        try:
            line = self._lines.get(timeout=ANSWER_S)
        except queue.Empty:
            raise ConfigError(f"the tool data base program does not answer within {ANSWER_S:g} s") from None
        if line is None:
            raise ConfigError("the tool data base program has ended")
        return line

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._lines.put(line.strip())
        self._lines.put(None)

"""The programs of docs/clients.md run, each as a process of its own, on one machine, in their order."""

import re
import subprocess
import sys

import pytest

from tests.support.machine import ROOT, copy_mill, running

pytestmark = pytest.mark.process

GUIDE = (ROOT / "docs" / "clients.md").read_text()
PROGRAMS = re.findall(r"^## (\d+\. .*?)\n.*?```python\n(.*?)```", GUIDE, re.MULTILINE | re.DOTALL)


def test_the_guide_has_ten_programs():
    assert [int(title.split(".")[0]) for title, _ in PROGRAMS] == list(range(1, 11))


def test_every_program_of_the_guide_runs(tmp_path):
    with running(copy_mill(tmp_path), speed=10.0) as run:
        run.port()
        for title, text in PROGRAMS:
            result = subprocess.run(
                [sys.executable, "-c", text], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
            )
            assert result.returncode == 0, f"{title}\n{result.stderr}"
            assert result.stdout or "asyncio" in text, title

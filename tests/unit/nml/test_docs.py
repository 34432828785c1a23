"""docs/nml.md: the tutorial runs as it stands, and the tables name every option."""

import re
from pathlib import Path

import pytest

from nml import config
from nml.config import BufferType, Mutex
from nml.message import registry

PAGE = (Path(__file__).parents[3] / "docs" / "nml.md").read_text()


def test_the_tutorial_runs_as_it_stands(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch):
    for name in ("NML_FILE", "INI_FILE_NAME"):
        monkeypatch.delenv(name, raising=False)
    saved = registry.pop(1605, None)
    blocks = re.findall(r"```python tutorial\n(.*?)```", PAGE, re.DOTALL)
    assert len(blocks) == 4
    names: dict[str, object] = {"__name__": "tutorial"}
    try:
        for block in blocks:
            exec(compile(block, "docs/nml.md", "exec"), names)
    finally:
        registry.pop(1605, None)
        if saved is not None:
            registry[1605] = saved
    assert capsys.readouterr().out == "clamping 3 with 2.5 N\n"


def test_every_type_and_option_of_an_nml_file_is_described():
    words = [kind.value for kind in BufferType] + [mutex.value for mutex in Mutex]
    for table in (config._BUFFER_FLAGS, config._PROCESS_FLAGS):
        words += table
    for table in (config._BUFFER_VALUES, config._PROCESS_VALUES):
        words += [f"{name}=" for name in table]
    assert [word for word in words if f"`{word}" not in PAGE] == []

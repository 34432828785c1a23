"""Every test lives in a namespace of its own, and leaves nothing behind in it.

Property tests try the same examples in every run, however long a busy computer takes for one.
"""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from nml import namespace

settings.register_profile("steady", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("steady")


@pytest.fixture(autouse=True)
def own_namespace(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A private namespace; whatever a failing test left of it is removed."""
    name = f"t{os.getpid()}-{uuid.uuid4().hex[:8]}"
    monkeypatch.setenv(namespace.VARIABLE, name)
    yield name
    os.environ[namespace.VARIABLE] = name
    prefix = namespace.shm_name("").lstrip("/")
    for path in Path("/dev/shm").glob(f"*{prefix}*"):
        path.unlink(missing_ok=True)
    shutil.rmtree(namespace.runtime_dir(), ignore_errors=True)

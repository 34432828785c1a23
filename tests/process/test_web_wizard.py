"""What the configuration wizard writes starts, homes and runs its first program."""

import json
import os
import signal
import subprocess
import sys
import urllib.request
from contextlib import contextmanager
from http.client import HTTPException

import pytest

from gui.web.wizard import make, samples
from nml.errors import ConfigError
from tests.support.machine import PATIENCE, ROOT, Run, processes, traces, wait_until
from tests.support.webclient import Refused, WebClient

pytestmark = pytest.mark.process

SHORT = {"min": -20.0, "max": 20.0, "switch": -4.0, "search": -20.0, "latch": 5.0}


def axes(letters, **values):
    """The same answers for several axes."""
    return {f"{letter}.{name}": value for letter in letters for name, value in values.items()}


MACHINES = {
    "mill": {},
    "inch_mill": {"units": "inch", "axes": "XY"},
    "lathe": {"machine_type": "lathe", "axes": "XZ", "back_tool": True},
    "foam": {"machine_type": "foam", "axes": "XYUV", "spindles": False},
    "rotary": {"axes": "XYZA"},
    "switches": {"homing": "switches", **axes("XYZ", **SHORT)},
    "servo": {"drive": "encoders", "homing": "switches", "tool_change": "at once", **axes("XYZ", **SHORT)},
    "stepper": {"drive": "steps", "base_period": 200.0, "axes": "XY", **axes("XY", velocity=20.0)},
}


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_of_the_wizard_starts_homes_and_runs_its_first_program(name, tmp_path):
    ini, wrong = make.generate(MACHINES[name], name, tmp_path)
    assert wrong == []
    run = Run(ini, "--run", str(ini.parent / "nc_files" / "welcome.ngc"))
    assert run.finish() == 0, run.errors
    assert "distance" in run.output
    assert traces() == []


@pytest.mark.parametrize("drive", ["none", "steps", "encoders"])
def test_a_machine_for_a_card_leaves_its_signals_open_and_has_no_findings(drive, tmp_path):
    answers = {
        "drive": drive,
        "hardware": "card",
        "homing": "switches",
        "X.velocity": 20.0,
        "Y.velocity": 20.0,
        "Z.velocity": 20.0,
    }
    ini, wrong = make.generate(answers, "card", tmp_path)
    assert wrong == []
    hal = ini.with_suffix(".hal").read_text()
    assert "net x-home => joint.0.home-sw-in" in hal
    assert ("net x-step <= stepgen.0.step" in hal) == (drive == "steps")


def test_every_sample_can_be_copied_and_its_copy_has_no_findings(tmp_path):
    listed = samples.listing()
    ours = [offer for offer in listed if offer["path"].startswith(str(samples.folders()[-1]))]
    assert ours
    for number, offer in enumerate(ours):
        ini, wrong = samples.copy(offer["path"], f"copy{number}", tmp_path)
        assert wrong == [], offer
        assert ".." not in ini.read_text()


def test_what_was_not_listed_is_not_copied(tmp_path):
    with pytest.raises(ConfigError, match="none of the configurations"):
        samples.copy("/etc/hostname", "x", tmp_path)


@contextmanager
def wizard(home):
    """The wizard's port; what it starts is ended too."""
    environment = os.environ | {"HOME": str(home), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-P", "-m", "gui.web", "--wizard", "--port", "0", "--no-browser"]
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True, cwd=home)
    try:
        assert process.stdout is not None
        address = process.stdout.readline()
        yield int(address.rstrip("/\n").rpartition(":")[2])
    finally:
        process.terminate()
        process.wait(PATIENCE)
        process.stdout.close()


def end_machine():
    """End the machine of this namespace, if the wizard has started one."""
    for pid, command in processes():
        if "linuxcnc_start" in command:
            os.kill(pid, signal.SIGTERM)
    wait_until(lambda: processes() == [], "ended")


def test_a_person_answers_questions_and_operates_the_new_machine_at_the_same_address(tmp_path):
    with wizard(tmp_path) as port:
        with WebClient(port) as page:
            assert page.hello["config"]["wizard"]
            with pytest.raises(Refused, match="no machine"):
                page.call("home")
            assert page.call("wizard.questions")[0]["key"] == "machine_type"
            assert page.call("wizard.check", answers={"X.min": 500.0})["errors"][0]["key"] == "X.max"
            made = page.call("wizard.generate", answers={"axes": "XY"}, name="mine")
            assert made["check"] == []
            with pytest.raises(Refused):
                page.call("wizard.start", ini="/etc/passwd")
            page.call("wizard.start", ini=made["ini"])
        try:
            wait_until(lambda: answers(port), "the machine's page")
            with WebClient(port) as page:
                assert page.hello["config"]["machine"] == "mine"
                page.wait(lambda state: state["machine"] == "ok", "machine")
                page.ready()
        finally:
            end_machine()


def answers(port):
    """Whether a machine's server is there, no longer the wizard's."""
    try:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/health", timeout=5) as answer:
            return json.load(answer).get("machine") == "ok"
    except (OSError, HTTPException, ValueError):  # the one ends, the other begins
        return False

"""Who gets into the web display, with what, and what hostile visitors achieve: nothing."""

import asyncio
import http.client
import json
import shutil
import ssl
import subprocess
import sys

import aiohttp
import msgpack
import pytest

from tests.support.machine import MILL, PATIENCE, wait_until
from tests.support.webclient import Refused, WebClient, web_mill

pytestmark = pytest.mark.process

OPERATOR, READER = "operator-token-0123456789", "reader-token-0123456789"
READERS = 50


@pytest.fixture
def mill(tmp_path):
    with web_mill(tmp_path, square="G21 G90\nG0 X10\nM2\n") as (run, port):
        run.web, run.folder = port, tmp_path
        yield run


@pytest.fixture
def guarded(tmp_path):
    tokens = tmp_path / "tokens"
    tokens.write_text(f"operator {OPERATOR}\nreader {READER}\n")
    tokens.chmod(0o600)
    with web_mill(tmp_path, extra="[WEB]\nTOKEN_FILE = tokens") as (_, port):
        yield port


def ask(port, method, path, body=None, **headers):
    """(status, headers, body) of one HTTP request."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    connection.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read()
    connection.close()
    return found


def first_close(port, *frames, text=False, origin=None):
    """The close code after these frames."""

    async def whole():
        base = f"http://127.0.0.1:{port}"
        headers = {"Origin": origin or base}
        async with aiohttp.ClientSession() as session, session.ws_connect(f"{base}/ws", headers=headers) as socket:
            for frame in frames:
                await (socket.send_str(frame) if text else socket.send_bytes(frame))
            while (message := await socket.receive(PATIENCE)).type is aiohttp.WSMsgType.BINARY:
                pass
            return message.data if message.type is aiohttp.WSMsgType.CLOSE else socket.close_code

    return asyncio.run(whole())


HELLO = msgpack.packb({"t": "hello"})


BAD_FRAMES = [
    (b"\xc1",),
    (b"",),
    (msgpack.packb([1, 2]),),
    (msgpack.packb({"t": 1}),),
    (msgpack.packb({"t": "call", "id": 1, "m": "machine.power"}),),
    (HELLO, msgpack.packb({"t": "hello"})),
    (HELLO, msgpack.packb({"t": "call", "id": "x"})),
    (HELLO, msgpack.packb({"t": "dance"})),
    (HELLO, b"\xdf\xff\xff\xff\xff"),
    (HELLO, b"\x81\xa1t" + b"\x91" * 5000 + b"\x01"),
]


def test_frames_that_make_no_sense_end_the_connection(mill):
    for frames in BAD_FRAMES:
        assert first_close(mill.web, *frames) in (1007, 1008), frames
    with WebClient(mill.web) as page:
        page.wait(lambda state: state.get("machine") == "ok", "the machine is there")


def test_frames_that_are_too_long_or_text_end_the_connection(mill):
    assert first_close(mill.web, HELLO, b"\x00" * (1 << 21)) == 1009
    assert first_close(mill.web, "hello", text=True) == 1008


WRONG_CALLS = [
    ("no.such", {}, "method"),
    ("machine.power", {"on": 1}, "argument"),
    ("machine.power", {}, "argument"),
    ("machine.power", {"on": True, "more": 1}, "argument"),
    ("override.feed", {"value": float("nan")}, "argument"),
    ("jog.start", {"axis": "Q", "velocity": 1.0}, "argument"),
    ("jog.start", {"axis": "X", "joint": 0, "velocity": 1.0}, "argument"),
    ("jog.start", {"axis": "X", "velocity": 0.0}, "state"),
    ("program.open", {"path": "../mill_mm.ini"}, "file"),
    ("program.read", {"path": "/etc/passwd"}, "file"),
    ("program.read", {"path": "a\0b"}, "file"),
    ("program.save", {"path": "../x.ngc", "text": ""}, "file"),
    ("program.save", {"path": ".x.ngc", "text": ""}, "file"),
    ("program.save", {"path": "x.sh", "text": ""}, "file"),
    ("mdi.run", {"text": "G0 X1\nG0 X2"}, "argument"),
    ("touchoff.axis", {"axis": "X", "value": "__import__('os')"}, "argument"),
    ("toolchange.load", {"tool": -1}, "argument"),
    ("hal.set", {"name": "joint.0.home-sw-in", "value": True}, "hal"),
]


def test_calls_that_are_wrong_are_refused_and_nothing_moves(mill):
    with WebClient(mill.web) as page:
        page.call("control.take")
        for method, arguments, code in WRONG_CALLS:
            with pytest.raises(Refused) as refused:
                page.call(method, **arguments)
            assert refused.value.code == code, (method, arguments)
        assert page.state["task_state"] == 1
        assert not any(page.state["position"])


def test_pages_of_other_servers_and_foreign_names_get_nothing(mill):
    with pytest.raises(aiohttp.WSServerHandshakeError):
        first_close(mill.web, HELLO, origin="http://evil.example")
    assert ask(mill.web, "GET", "/", Host="evil.example")[0] == 403
    status = ask(mill.web, "POST", "/upload?name=a.ngc", b"M2\n", Origin="http://evil.example")[0]
    assert status == 403
    own = f"http://127.0.0.1:{mill.web}"
    assert ask(mill.web, "POST", "/upload?name=a.ngc", b"M2\n", Origin=own)[0] == 403  # a form cannot set our header


def test_every_answer_tells_the_browser_what_it_may_do(mill):
    _, headers, _ = ask(mill.web, "GET", "/health")
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert ask(mill.web, "GET", "/page/../server.py")[0] == 404
    assert ask(mill.web, "GET", "/page/%2e%2e/server.py")[0] == 404


BAD_NAMES = ("../x.ngc", "x.exe", ".x.ngc", "", "a\nb.ngc", "a/b.ngc", "x" * 300 + ".ngc")


def test_uploads_stay_in_the_program_folder(mill):
    with WebClient(mill.web) as page:
        assert page.upload("ok.ngc", "M2\n") == 200
        assert page.upload("ok.ngc", "M30\n") == 409
        for name in BAD_NAMES:
            assert page.upload(name, "M2\n") == 400, name
    assert sorted(path.name for path in (mill.folder / "nc").iterdir()) == ["ok.ngc", "square.ngc"]


def test_uploads_do_not_follow_links_out_of_the_folder(mill):
    outside = mill.folder / "secret.ngc"
    outside.write_text("secret")
    (mill.folder / "nc" / "link.ngc").symlink_to(outside)
    (mill.folder / "nc" / "out").symlink_to(mill.folder)
    with WebClient(mill.web) as page:
        assert page.upload("link.ngc", "M2\n", replace=True) == 400
        for path in ("link.ngc", "out/secret.ngc"):
            with pytest.raises(Refused):
                page.call("program.read", path=path)
        assert [entry["name"] for entry in page.call("program.list")["entries"]] == ["square.ngc"]
    assert outside.read_text() == "secret"


def test_an_upload_that_is_too_large_leaves_nothing_behind(tmp_path):
    with web_mill(tmp_path, extra="[WEB]\nUPLOAD_LIMIT = 0.01") as (_, port), WebClient(port) as page:
        assert page.upload("big.ngc", "G0 X1\n" * 5000) == 413
    assert list((tmp_path / "nc").iterdir()) == []


def test_two_operators_share_one_set_of_controls(mill):
    with WebClient(mill.web, name="anna") as anna, WebClient(mill.web, name="bert") as bert:
        anna.take()
        bert.wait(lambda state: state["control"] and state["control"]["name"] == "anna", "seen")
        with pytest.raises(Refused, match="anna"):
            bert.call("machine.estop_reset")
        with pytest.raises(Refused, match="anna"):
            bert.call("control.take")
        bert.call("control.request")
        anna.wait(lambda state: state["control_request"], "asked")
        anna.call("control.hand", client=bert.hello["client"])
        bert.call("machine.estop_reset")
        with pytest.raises(Refused):
            anna.call("machine.power", on=True)
        anna.call("machine.estop")  # stopping is always allowed
        bert.wait(lambda state: state["task_state"] == 1, "stopped")
        bert.call("control.release")
        anna.wait(lambda state: state["control"] is None, "free")


def test_who_took_the_controls_is_said_to_each_in_his_language(mill):
    with WebClient(mill.web, name="Anna") as anna, WebClient(mill.web, name="Bert", lang="de") as bert:
        anna.take()
        bert.call("control.take", force=True)
        anna.wait(lambda _: anna.messages, "the notice")
        bert.wait(lambda _: bert.messages, "the notice")
        assert anna.messages[-1]["text"] == "Bert took the controls from Anna"
        assert bert.messages[-1]["text"] == "Bert hat Anna die Bedienung abgenommen"
        assert bert.call("messages.read")[-1]["text"] == bert.messages[-1]["text"]


def test_roles_come_with_tokens(guarded):
    with pytest.raises(ConnectionError, match="4401"):
        WebClient(guarded, token="wrong" * 5).__enter__()
    with WebClient(guarded, token=READER) as reader, WebClient(guarded, token=OPERATOR) as operator:
        assert reader.hello["role"] == "reader"
        for method in ("control.take", "machine.estop", "program.pause"):
            with pytest.raises(Refused) as refused:
                reader.call(method)
            assert refused.value.code == "role"
        assert reader.upload("x.ngc", "M2\n") == 403
        assert operator.upload("x.ngc", "M2\n") == 200
        operator.call("control.take")
        assert ask(guarded, "GET", "/program?path=x.ngc")[0] == 401
        assert ask(guarded, "GET", "/program?path=x.ngc", Authorization=f"Bearer {READER}")[2] == b"M2\n"


def test_fifty_readers_see_the_machine_move(mill):
    def at_ten(state):
        return state["position"][0] == 10.0

    readers = [WebClient(mill.web, name=f"reader {number}").__enter__() for number in range(READERS)]
    try:
        with WebClient(mill.web) as page:
            page.ready()
            page.call("mdi.run", text="G0 X10")
            for reader in readers:
                reader.wait(at_ten, "seen")
            page.wait(lambda state: len(state["clients"]) == READERS + 1, "all are there")
    finally:
        for reader in readers:
            reader.__exit__()


def test_a_client_that_does_not_read_holds_up_nobody(mill):
    with WebClient(mill.web, name="deaf") as deaf, WebClient(mill.web) as page:
        deaf.cut()
        page.ready()
        for number in range(20):
            page.call("mdi.run", text=f"G0 X{number % 2}")
        page.wait(lambda state: state["position"][0] == 1.0, "moved")


def refusal(tmp_path, *lines):
    """What linuxcnc-web says to an INI file with these lines of [WEB]."""
    ini = tmp_path / "a.ini"
    text = (MILL / "mill_mm.ini").read_text().replace("PROGRAM_PREFIX = ../nc_files", f"PROGRAM_PREFIX = {tmp_path}")
    ini.write_text(text + "\n[WEB]\n" + "\n".join(lines) + "\n")
    command = [sys.executable, "-P", "-m", "gui.web", "-ini", str(ini), "--port", "0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1, done.stderr
    return done.stderr


def test_an_address_of_the_network_needs_tokens_and_tls(tmp_path):
    assert "TOKEN_FILE, TLS_CERTIFICATE, TLS_KEY" in refusal(tmp_path, "HOST = 0.0.0.0")


def test_tokens_that_others_can_read_or_guess_are_refused(tmp_path):
    tokens = tmp_path / "tokens"
    tokens.write_text(f"operator {OPERATOR}\n")
    tokens.chmod(0o644)
    assert "chmod 600" in refusal(tmp_path, "TOKEN_FILE = tokens")
    tokens.chmod(0o600)
    tokens.write_text("operator short\n")
    assert "tokens:1: the token is too short" in refusal(tmp_path, "TOKEN_FILE = tokens")


def test_the_machines_health_needs_no_token(guarded):
    wait_until(lambda: json.loads(ask(guarded, "GET", "/health")[2]) == {"machine": "ok"}, "healthy")


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl makes the certificate")
def test_with_a_certificate_everything_is_encrypted(tmp_path):
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost"]
    command += ["-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"]
    subprocess.run([*command, "-keyout", "key.pem", "-out", "cert.pem"], cwd=tmp_path, check=True, capture_output=True)
    tokens = tmp_path / "tokens"
    tokens.write_text(f"reader {READER}\n")
    tokens.chmod(0o600)
    extra = "[WEB]\nTOKEN_FILE = tokens\nTLS_CERTIFICATE = cert.pem\nTLS_KEY = key.pem"
    with web_mill(tmp_path, extra=extra) as (run, port):
        trusted = ssl.create_default_context(cafile=str(tmp_path / "cert.pem"))
        connection = http.client.HTTPSConnection("localhost", port, timeout=PATIENCE, context=trusted)

        def health():
            connection.request("GET", "/health")
            return json.loads(connection.getresponse().read())

        wait_until(lambda: health() == {"machine": "ok"}, "healthy")
        with pytest.raises((http.client.HTTPException, OSError)):
            ask(port, "GET", "/health")
        run.stop()
        assert f"https://127.0.0.1:{port}/" in run.output

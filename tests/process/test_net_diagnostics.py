"""The report of a buffer declared ``diag``, byte by byte."""

import time

import pytest

from nml.channel import Channel
from nml.emc import EMC_STAT
from tests.support import diagnosed
from tests.support.nml_server import free_port, nml_text, running

pytestmark = pytest.mark.process


def test_the_report_names_each_process_with_its_counts_and_times(tmp_path):
    port = free_port()
    with running(tmp_path, nml_text(f"TCP={port}", {"emcStatus": "diag"})) as server:
        machine = Channel(server.config, "emcStatus", "emc")
        machine.write(EMC_STAT())
        machine.write(EMC_STAT())
        head, entries = diagnosed.report(port)
        machine.close()
    serial, status, writer, reader, now, count, size = head
    assert (serial, status, count, size) == (3, 0, len(entries), 32 + 140 * len(entries))
    assert now == pytest.approx(time.time(), abs=60.0)
    assert entries[writer].name == b"emc"
    assert (entries[writer].access, entries[writer].accesses, entries[writer].new) == (4, 2, 2)
    assert entries[writer].shortest <= entries[writer].longest < 60.0
    client = entries[reader]
    assert client[:5] == (diagnosed.NAME, diagnosed.HOST, diagnosed.PID, diagnosed.VERSION, 3)
    assert (client.accesses, client.new, client.last_id, client.last_size) == (1, 1, 2, 3876)
    assert client.first == client.last == pytest.approx(now, abs=60.0)
    assert (client.shortest, client.longest) == (10_000.0, 0.0)
    assert [one.wrote_last for one in entries] == [index == writer for index in range(count)]
    assert [one.read_last for one in entries] == [index == reader for index in range(count)]

"""The units under a real systemd, on a real vcan0, with the sandbox they ship with."""

import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from needs import needs

from .conftest import PLACE
from .systemd_guest import SYSTEMD, Manager, booted, install

pytestmark = pytest.mark.skipif(
    PLACE != "uml", reason="changes /etc: only where changes are thrown away"
)


@pytest.fixture(scope="module")
def systemd() -> Iterator[Manager]:
    needs(SYSTEMD.exists(), "systemd")
    install("tcs-hil", "tcs-hil-metrics", "tcs-hil-record")
    configuration = Path("/etc/tcs-hil/tcs-hil.toml")
    text = configuration.read_text()
    # Less to compute and to store: the guest's machine is a slow one.
    configuration.write_text(text.replace('"kmpc"', '"pi"').replace("150_000", "5_000"))
    with booted() as manager:
        yield manager


@pytest.fixture(scope="module")
def service(systemd: Manager) -> Manager:
    systemd.run("systemctl", "start", "tcs-hil.service")  # returns once it has said READY=1
    return systemd


def status_of(service: Manager) -> dict[str, str]:
    pid = service.show("tcs-hil", "MainPID")
    lines = service.run("cat", f"/proc/{pid}/status").splitlines()
    return {name: value.strip() for name, _, value in (line.partition(":") for line in lines)}


def test_it_gets_real_time_and_locked_memory_without_any_capability(service: Manager) -> None:
    status = status_of(service)
    for name in ("CapEff", "CapPrm", "CapBnd", "CapAmb"):
        assert int(status[name], 16) == 0
    assert int(status["Uid"].split()[0]) != 0
    assert int(status["VmLck"].split()[0]) > 0
    assert "SCHED_FIFO" in service.run("chrt", "-p", service.show("tcs-hil", "MainPID"))


def test_it_runs_behind_its_system_call_filter_on_the_real_bus(service: Manager) -> None:
    status = status_of(service)
    assert (status["NoNewPrivs"], status["Seccomp"]) == ("1", "2")
    assert "bus: socketcan vcan0" in service.run("cat", "/run/tcs-hil.log")


def test_metrics_of_the_service_are_served_by_the_unit_beside_it(service: Manager) -> None:
    service.run("ip", "link", "set", "lo", "up")
    service.run("systemctl", "start", "tcs-hil-metrics.service")
    with urllib.request.urlopen("http://127.0.0.1:9555/metrics", timeout=20.0) as answer:
        text = answer.read().decode()
    assert 'tcs_hil_run_info{bus="socketcan vcan0",controller="pi"} 1.0' in text
    service.run("systemctl", "stop", "tcs-hil-metrics.service")


def test_the_recorder_beside_it_writes_a_file_per_start(service: Manager) -> None:
    service.run("systemctl", "start", "tcs-hil-record.service")
    service.run("systemctl", "stop", "tcs-hil-record.service")
    (name,) = service.run("ls", "/var/lib/tcs-hil-record").split()
    assert name.endswith(".blf")
    assert service.show("tcs-hil-record", "Result") == "success"


def test_killed_it_is_restarted_and_its_recording_kept(service: Manager) -> None:
    before = int(service.show("tcs-hil", "NRestarts"))
    service.run("systemctl", "kill", "--signal=KILL", "tcs-hil.service")
    service.await_restart("tcs-hil", before + 1)
    assert "flight.previous" in service.run("ls", "/run/tcs-hil")


def test_one_that_hangs_is_replaced_by_the_watchdog(service: Manager) -> None:
    before = int(service.show("tcs-hil", "NRestarts"))
    service.run("systemctl", "kill", "--signal=STOP", "tcs-hil.service")
    service.await_restart("tcs-hil", before + 1)


def test_told_to_stop_it_ends_well(service: Manager) -> None:
    service.run("systemctl", "stop", "tcs-hil.service")
    assert service.show("tcs-hil", "Result") == "success"
    assert service.show("tcs-hil", "ExecMainStatus") == "0"

"""sd_notify spoken to a real socket."""

from __future__ import annotations

import secrets
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from tcs_hil.runtime.notify import Watchdog, notify


@pytest.fixture
def manager() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as channel:
        channel.setblocking(False)
        yield channel


def test_a_state_arrives_at_a_socket_with_a_path(
    manager: socket.socket, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    manager.bind(str(tmp_path / "notify"))
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "notify"))
    assert notify("READY=1\nSTATUS=kmpc on vcan0 at 2 ms")
    assert manager.recv(100) == b"READY=1\nSTATUS=kmpc on vcan0 at 2 ms"


def test_a_state_arrives_at_an_abstract_socket(
    manager: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = f"tcs-hil-{secrets.token_hex(8)}"
    manager.bind(f"\0{name}")
    monkeypatch.setenv("NOTIFY_SOCKET", f"@{name}")
    assert notify("STOPPING=1")
    assert manager.recv(100) == b"STOPPING=1"


def test_without_a_service_manager_nothing_is_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NOTIFY_SOCKET", raising=False)
    assert not notify("READY=1")


def test_a_manager_that_has_gone_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "gone"))
    assert not notify("READY=1")


def test_a_manager_that_does_not_read_never_blocks_the_tick(
    manager: socket.socket, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    manager.bind(str(tmp_path / "notify"))
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "notify"))
    assert not all(notify("WATCHDOG=1") for _ in range(10_000))


@pytest.fixture
def sent() -> list[str]:
    return []


@pytest.fixture
def watchdog(sent: list[str], monkeypatch: pytest.MonkeyPatch) -> Watchdog:
    monkeypatch.setenv("WATCHDOG_USEC", "100000")
    return Watchdog(lambda state: not sent.append(state))


def test_healthy_ticks_feed_the_watchdog_twice_per_interval(
    watchdog: Watchdog, sent: list[str]
) -> None:
    for tick in range(100):
        watchdog.feed(tick * 2_000_000)
    assert sent == ["WATCHDOG=1"] * 4


def test_a_watchdog_nobody_asked_for_stays_silent(
    sent: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("WATCHDOG_USEC", raising=False)
    Watchdog(lambda state: not sent.append(state)).feed(10**12)
    assert sent == []

"""One service to a channel: claimed by a name that no death can leave behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import uuid

import pytest

from tcs_hil.errors import BusError
from tcs_hil.service.claim import ChannelClaim

HOLD = """
import signal, sys
from tcs_hil.service.claim import ChannelClaim
with ChannelClaim("embedded", sys.argv[1]):
    print("held", flush=True)
    signal.pause()
"""


@pytest.fixture
def channel() -> str:
    return f"vcan-{uuid.uuid4().hex}" * 5  # longer than a socket's name may be


def test_a_second_claim_is_refused_and_the_holder_named(channel: str) -> None:
    with ChannelClaim("embedded", channel):
        for _ in range(3):
            with pytest.raises(BusError, match=rf"service \(process {os.getpid()}\)$"):
                ChannelClaim("embedded", channel)


def test_a_claim_ends_with_its_context(channel: str) -> None:
    for _ in range(2):
        with ChannelClaim("embedded", channel):
            pass


def test_another_channel_and_another_interface_are_free(channel: str) -> None:
    with (
        ChannelClaim("embedded", channel),
        ChannelClaim("embedded", f"{channel}x"),
        ChannelClaim("socketcan", channel),
    ):
        pass


def test_a_killed_holder_leaves_nothing_behind(channel: str) -> None:
    holder = subprocess.Popen(
        [sys.executable, "-c", HOLD, channel],
        stdout=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    )
    with holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"held\n"
        with pytest.raises(BusError, match=rf"\(process {holder.pid}\)$"):
            ChannelClaim("embedded", channel)
        holder.send_signal(signal.SIGKILL)
        holder.wait()
    with ChannelClaim("embedded", channel):
        pass

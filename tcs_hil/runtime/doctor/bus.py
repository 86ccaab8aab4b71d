"""The CAN interface."""

from __future__ import annotations

import msgspec

from tcs_hil.runtime.doctor.finding import Finding, fail, ok, warn
from tcs_hil.runtime.doctor.machine import Machine

BITRATE = 500_000
"""What the contract of the bus is laid out for, bit/s."""


class Timing(msgspec.Struct, frozen=True):
    """Bit timing of a CAN controller."""

    bitrate: int = 0


class ErrorCounters(msgspec.Struct, frozen=True):
    """How ill a CAN controller is, sending and receiving; 128 of one makes it error-passive."""

    tx: int = 0
    rx: int = 0


class Controller(msgspec.Struct, frozen=True):
    """What a CAN controller says of itself; empty for a virtual interface."""

    state: str = ""
    restart_ms: int = 0
    bittiming: Timing = Timing()
    berr_counter: ErrorCounters = ErrorCounters()


class Kind(msgspec.Struct, frozen=True):
    """Which kind of interface it is."""

    info_kind: str = ""
    info_data: Controller = Controller()


class Link(msgspec.Struct, frozen=True):
    """An interface as ``ip -details -json link`` describes it."""

    ifname: str = ""
    flags: tuple[str, ...] = ()
    linkinfo: Kind = Kind()


def socketcan(machine: Machine) -> Finding:
    """Whether the kernel speaks CAN at all."""
    if machine.speaks_can():
        return ok("SocketCAN", "in this kernel")
    return warn("SocketCAN", "not in this kernel", "sudo modprobe can-raw")


def interface(machine: Machine, channel: str) -> Finding:
    """Whether ``channel`` is there, up, healthy and at the right bit rate."""
    what = f"interface {channel}"
    link = _link(machine, channel)
    if link is None:
        return _missing(what, channel)
    if "UP" not in link.flags:
        return fail(what, f"{link.linkinfo.info_kind}, down", _bring_up(channel, link))
    if link.linkinfo.info_kind != "can":
        return ok(what, f"{link.linkinfo.info_kind}, up")
    return _controller(what, channel, link.linkinfo.info_data)


def _link(machine: Machine, channel: str) -> Link | None:
    text = machine.run("ip", "-details", "-json", "link", "show", "dev", channel)
    links = msgspec.json.decode(text or "[]", type=list[Link])
    # Some versions print an empty object for every interface that was not asked for.
    return next((link for link in links if link.ifname == channel), None)


_MISMATCH = "bit rate mismatch? compare the other nodes', then check wiring and termination"
_SET = f"sudo ip link set {{}} up type can bitrate {BITRATE} restart-ms 100"


def _missing(what: str, channel: str) -> Finding:
    if channel.startswith("vcan"):
        remedy = f"sudo ip link add dev {channel} type vcan && sudo ip link set {channel} up"
        return warn(what, "not there; the embedded bus takes its place", remedy)
    return fail(what, "not there", f"load the adapter's driver, then {_SET.format(channel)}")


def _bring_up(channel: str, link: Link) -> str:
    if link.linkinfo.info_kind == "can":
        return _SET.format(channel)
    return f"sudo ip link set {channel} up"


def _controller(what: str, channel: str, controller: Controller) -> Finding:
    bitrate, state, errors = controller.bittiming.bitrate, controller.state, controller.berr_counter
    found = f"{bitrate} bit/s, {state}"
    ill = f"{found}, errors sending {errors.tx}, receiving {errors.rx}"
    if state == "BUS-OFF":
        restart = f"then sudo ip link set {channel} type can restart"
        return fail(what, ill, f"{_MISMATCH}; {restart}")
    if bitrate != BITRATE:
        again = f"sudo ip link set {channel} down && {_SET.format(channel)}"
        return warn(what, f"{found}; the bus is laid out for {BITRATE}", again)
    if state != "ERROR-ACTIVE":
        return warn(what, ill, _MISMATCH)
    if not controller.restart_ms:
        again = f"sudo ip link set {channel} down && {_SET.format(channel)}"
        return warn(what, f"{found}; stays off after bus-off", again)
    return ok(what, f"{found}, restarts after {controller.restart_ms} ms")

"""Which bus is opened, and how a refusal reads."""

from __future__ import annotations

import pytest
from can.interfaces.virtual import VirtualBus

from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.embedded import EmbeddedBus
from tcs_hil.errors import BusError

MISSING_VCAN = "vcan-none"  # a name no machine has


def test_auto_falls_back_to_the_embedded_bus_for_a_vcan_the_kernel_has_not():
    bus, description = open_bus("auto", MISSING_VCAN)
    with bus:
        assert isinstance(bus, EmbeddedBus)
        assert (
            description == f"embedded {MISSING_VCAN} (this kernel has no SocketCAN {MISSING_VCAN})"
        )


def test_auto_never_replaces_a_real_interface_by_an_embedded_bus():
    with pytest.raises(BusError, match=r"no CAN interface can-none.*ip link set can-none up type"):
        open_bus("auto", "can-none")


def test_an_interface_of_another_kind_is_no_can_interface():
    with pytest.raises(BusError, match="no CAN interface lo"):
        open_bus("auto", "lo")


def test_a_missing_socketcan_interface_is_named_with_its_remedy():
    with pytest.raises(BusError, match=rf"no CAN interface {MISSING_VCAN} .*ip link add dev"):
        open_bus("socketcan", MISSING_VCAN)


def test_any_other_interface_of_python_can_passes_through():
    bus, description = open_bus("virtual", "somewhere", bitrate=500_000)
    with bus:
        assert isinstance(bus, VirtualBus)
        assert description == "virtual somewhere"


def test_a_bit_rate_for_a_bus_without_a_wire_is_refused():
    with pytest.raises(BusError, match=f"bitrate 500000: has no effect on embedded {MISSING_VCAN}"):
        open_bus("auto", MISSING_VCAN, bitrate=500_000)


@pytest.mark.parametrize("interface", ["bogus", "pcan"])
def test_an_interface_python_can_cannot_open_is_named(interface):
    with pytest.raises(BusError, match=f"cannot open {interface} ch0: "):
        open_bus(interface, "ch0")


def test_an_impossible_embedded_channel_is_refused():
    with pytest.raises(BusError, match="cannot open embedded a/b: "):
        open_bus("embedded", "a/b")

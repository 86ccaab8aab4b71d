"""A map is looked over as a whole: every fault at once, and the DBC with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tcs_hil.canbus.mapping.findings import Finding
from tcs_hil.errors import ConfigError
from tcs_hil.service.bus_end import bus_end

from .examined import ERROR, GONE, config_with, found
from .makers import AURELIS, FOLDER, MAKERS, MONTANE, Maker


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
def test_the_makers_maps_have_no_fault(maker: Maker) -> None:
    assert ERROR not in {finding.weight for finding in found(maker)}


def test_every_fault_is_found_in_one_go() -> None:
    changes = {
        "map__inputs__wheel_speed_fl": GONE,
        "map__inputs__wheel_speed_fr__unit": "Nm",
        "map__limits__left": GONE,
        "map__messages__INV_State__checksum__signal": "INV_RollCnt",
    }
    keys = {f.key for f in found(MONTANE, **changes) if f.weight is ERROR}
    assert keys == {
        "inputs.wheel_speed_fl",
        "inputs.wheel_speed_fr",
        "limits.left",
        "messages.INV_State.checksum",
    }
    with pytest.raises(ConfigError, match=r"\(and 3 more: tcs-hil map check\)$"):
        bus_end(config_with(MONTANE, **changes))


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("BO_ 288 ", "BO_ 2147483936 ", "has the 29-bit identifier 0x120; the service speaks"),
        ("BO_ 288 ABS_WhlSpd_Frnt: 8 ", "BO_ 288 ABS_WhlSpd_Frnt: 16 ", "is CAN FD"),
    ],
)
def test_frames_the_port_cannot_carry_are_refused(
    tmp_path: Path, old: str, new: str, sentence: str
) -> None:
    text = (FOLDER / "montane.dbc").read_text()
    assert old in text
    (tmp_path / "car.dbc").write_text(text.replace(old, new).replace("BO_ 288 2;", "BO_ 290 2;"))
    findings = found(MONTANE, bus__database=str(tmp_path / "car.dbc"))
    assert any(sentence in f.sentence for f in findings if f.weight is ERROR)


def test_a_floating_point_signal_is_refused(tmp_path: Path) -> None:
    text = (FOLDER / "aurelis.dbc").read_text()
    wide = text.replace("Body_ax : 16|16@1+ (0.001,-32)", "Body_ax : 16|32@1- (1,0)")
    (tmp_path / "car.dbc").write_text(wide + "SIG_VALTYPE_ 97 Body_ax : 1;\n")
    findings = found(AURELIS, bus__database=str(tmp_path / "car.dbc"))
    assert Finding(ERROR, "inputs.accel_x", "EscBody.Body_ax is a floating-point signal") in (
        findings
    )


def test_a_map_needs_a_dbc_and_a_check_needs_a_map() -> None:
    with pytest.raises(ConfigError, match=r"bus\.database: is missing"):
        found(MONTANE, bus__database=GONE)
    with pytest.raises(ConfigError, match="map: is missing"):
        found(MONTANE, map=GONE)


def test_lockstep_wants_its_identifiers_to_itself(tmp_path: Path) -> None:
    text = (FOLDER / "montane.dbc").read_text().replace("304", "2032")
    (tmp_path / "car.dbc").write_text(text)
    changes = {"bus__database": str(tmp_path / "car.dbc")}
    assert ERROR not in {f.weight for f in found(MONTANE, **changes)}
    lockstep = found(MONTANE, **changes, tick__trigger="lockstep")
    assert Finding(ERROR, "tick.trigger", "lockstep needs the identifier that ABS_LongAcc has") in (
        lockstep
    )

"""Quendal: a multiplexer, split counters, percent; no motors, no acceleration."""

from __future__ import annotations

from collections.abc import Callable

from tcs_hil.signals import NO_LIMIT, Measurement, TorqueLimits

from .car import KMPH, Maker, Sign, Talk, Values, wheels

QUENDAL_FULL_NM = 260.0


def _split(low: tuple[int, int, int], high: tuple[int, int, int]) -> Sign:
    """Counter of four bits in two places: each byte, shift and number of bits."""

    def sign(frame: bytearray, count: int) -> None:
        count %= 16
        for byte, shift, bits in (low, high):
            mask = (1 << bits) - 1
            frame[byte] = frame[byte] & ~(mask << shift) & 0xFF | (count & mask) << shift
            count >>= bits

    return sign


WHEEL_SPLIT = (0, 3, 2), (6, 6, 2)


def _page(page: int, left: int, names: tuple[str, str]) -> Callable[[Measurement], Values]:
    speeds = wheels(left, names, KMPH)
    return lambda m: {"WHL_Page": page, **speeds(m)}


def _quendal_limits(values: Values) -> TorqueLimits:
    assert values["TCU_Page"] == 1
    percent = (values["TCU_MaxL"], values["TCU_MaxR"])
    limits = [NO_LIMIT if p == 4095 * 0.03 else p / 100.0 * QUENDAL_FULL_NM for p in percent]
    assert values["TCU_Intervene"] == (2 if min(limits) < NO_LIMIT else 1)
    return TorqueLimits(*limits)


def _quendal_demand(m: Measurement) -> Values:
    left, right = (100.0 * torque_nm / QUENDAL_FULL_NM for torque_nm in m.driver_torque_nm)
    return {"DRV_PedL": left, "DRV_PedR": right}


QUENDAL = Maker(
    name="quendal",
    talks=(
        Talk("WHL_DATA", 1, _page(1, 0, ("WHL_VL", "WHL_VR")), _split(*WHEEL_SPLIT)),
        Talk("WHL_DATA", 1, _page(2, 2, ("WHL_HL", "WHL_HR")), _split(*WHEEL_SPLIT)),
        Talk("DRV_REQ", 5, _quendal_demand, _split((1, 5, 1), (3, 5, 3))),
    ),
    limit_message="TCU_LIM",
    limits=_quendal_limits,
    sign_limit=_split((0, 2, 2), (3, 6, 2)),
)

"""Keys to what the bench asks of the emulator.  Pure."""

from __future__ import annotations

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl, BenchFault

THROTTLE_STEP_NM = 10.0
THROTTLE_MAX_NM = 500.0
MU_STEP = 0.05
MU_MIN, MU_MAX = 0.05, 1.5
FIRST_MU = 0.3
"""Snow: what the first press puts under the wheels, since nobody can read the road's own."""

_THROTTLE = {"up": THROTTLE_STEP_NM, "down": -THROTTLE_STEP_NM}
_MU = {"right": MU_STEP, "left": -MU_STEP}
_FAULTS = {str(int(fault)): fault for fault in BenchFault if fault is not BenchFault.NONE}

KEYS = (*_THROTTLE, *_MU, *_FAULTS, "space")


def press(control: BenchControl, key: str, request_nm: float) -> BenchControl:
    """What is asked for after ``key``; the first throttle starts from ``request_nm``."""
    if key == "space":
        return AS_IN_SCENARIO
    if key in _THROTTLE:
        return control._replace(throttle_nm=_throttled(control, request_nm, _THROTTLE[key]))
    if key in _MU:
        return control._replace(mu_ratio=_on_road(control, _MU[key]))
    fault = _FAULTS[key]
    return control._replace(fault=BenchFault.NONE if control.fault is fault else fault)


def _throttled(control: BenchControl, request_nm: float, step_nm: float) -> float:
    held_nm = control.throttle_nm
    if held_nm is None:
        held_nm = THROTTLE_STEP_NM * round(request_nm / THROTTLE_STEP_NM)
    return min(max(held_nm + step_nm, 0.0), THROTTLE_MAX_NM)


def _on_road(control: BenchControl, step: float) -> float:
    if control.mu_ratio is None:
        return FIRST_MU
    return round(min(max(control.mu_ratio + step, MU_MIN), MU_MAX), 3)

"""The two manoeuvres of the paper on the whole car, entered where slip control is at work."""

from __future__ import annotations

from plant_emulator.driver import Driver
from plant_emulator.road import Patch
from plant_emulator.scenario import Scenario

FAULT_S = 0.7
"""When the fault comes: every law holds both motors by then."""

SLOW_MANOEUVRE = "manoeuvre-1"
"""Below 2 m/s when the fault comes."""

_FULL_THROTTLE = Driver(request=((0.1, 0.0), (0.6, 250.0)))

MANOEUVRES = {
    SLOW_MANOEUVRE: Scenario(
        description="full throttle from 2 km/h on mu 0.3",
        duration_s=8.0,
        start_speed_kmph=2.0,
        road=(Patch(mu=0.3),),
        driver=_FULL_THROTTLE,
    ),
    "manoeuvre-2": Scenario(
        description="full throttle at 18 km/h, friction falling from 0.3 to 0.15 under the fault",
        duration_s=8.0,
        start_speed_kmph=18.0,
        road=(
            Patch(mu=0.3),
            Patch(from_m=4.0, mu=0.15),
            Patch(from_m=14.0, mu=0.6),
            Patch(from_m=24.0, mu=0.3),
        ),
        driver=_FULL_THROTTLE,
    ),
}
"""The second is the paper's from six metres before its ice on, at the speed it is reached with."""

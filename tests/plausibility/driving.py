"""A car on the bus that nobody controls, and what is believed of it."""

from __future__ import annotations

from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.hil.busless import BuslessCar
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.plausibility import Plausibility

PERIOD_S = 0.002


def suspects_of(scenario: Scenario) -> list[int]:
    """Bits of suspects, tick by tick; the driver gets all he asks for."""
    node = TcsNode(load_database())
    car = BuslessCar(scenario, TruthRecorder(None, scenario, in_memory=True))
    plausibility = Plausibility(Vehicle(), PERIOD_S)
    suspects = []
    while not car.finished:
        for frame in car.speak():
            node.feed(*frame)
        measurement = node.measurement(car.now_ns)
        suspects.append(plausibility.suspects(measurement))
        plausibility.sent(measurement.driver_torque_nm)
        car.drive_on()
    return suspects

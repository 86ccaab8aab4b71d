"""A car on the bus that nobody controls, and what is believed of it."""

from __future__ import annotations

from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.plausibility import Plausibility

PERIOD_S = 0.002


class Ear:
    """Hears the vehicle's frames the moment they come through."""

    def __init__(self, node: TcsNode) -> None:
        self._node = node
        self.now_ns = 0

    def send(self, frame_id: int, data: bytes) -> bool:
        self._node.feed(frame_id, data, self.now_ns)
        return True


def suspects_of(scenario: Scenario) -> list[int]:
    """Bits of suspects, tick by tick; the driver gets all he asks for."""
    database = load_database()
    node = TcsNode(database)
    ear = Ear(node)
    recorder = TruthRecorder(None, scenario, in_memory=True)
    emulator = Emulator(Plant(scenario), VehicleNode(database), ear, recorder)
    plausibility = Plausibility(Vehicle(), PERIOD_S)
    suspects = []
    while not emulator.plant.finished:
        emulator.publish()
        measurement = node.measurement(ear.now_ns)
        suspects.append(plausibility.suspects(measurement))
        plausibility.sent(measurement.driver_torque_nm)
        ear.now_ns += PERIOD_NS
        emulator.advance_to(ear.now_ns)
    return suspects

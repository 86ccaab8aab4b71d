"""Any frames in any order at any time: what must hold of the service's inputs throughout."""

from __future__ import annotations

import math

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.signals import BusCondition, InputState

DATABASE = load_database()
CYCLE_NS = 2_000_000
OWN_IDS = sorted(DATABASE.frame_ids_of("TCS"))
INPUT_IDS = sorted(DATABASE.frame_ids_of("VEHICLE"))
NO_DATA, INIT, VALID, INVALID = (InputState(number) for number in range(4))
LEGAL = {
    (NO_DATA, NO_DATA),
    (NO_DATA, INIT),
    (INIT, INIT),
    (INIT, VALID),
    (INIT, INVALID),
    (VALID, VALID),
    (VALID, INVALID),
    (INVALID, INVALID),
    (INVALID, VALID),
}
# The state is looked at after every frame, so these are all the steps there are.
VALUES = (
    "wheel_speed_radps",
    "wheel_speed_valid",
    "motor_speed_radps",
    "motor_torque_nm",
    "driver_torque_nm",
)
STATES = ("front_speed_state", "rear_speed_state", "motor_state", "driver_state")
AGES = ("front_speed_age_s", "rear_speed_age_s", "motor_age_s", "driver_age_s")


def values(seen):
    return tuple(getattr(seen, name) for name in VALUES)


class AnyFrames(RuleBasedStateMachine):
    """A service, a vehicle it belongs to, and a bus on which anything may happen."""

    def __init__(self):
        super().__init__()
        self.node = TcsNode(DATABASE)
        self.vehicle = VehicleNode(DATABASE)
        self.now_ns = 0
        self.spoken_ns = 0
        self.seen = self.node.measurement(0)

    def feed(self, frame_id, data):
        before = self.node.counters.good, self.node.counters.own_id
        good = self.node.feed(frame_id, data, self.now_ns)
        assert good == (self.node.counters.good > before[0])
        self.look(changed=good, intruded=self.node.counters.own_id > before[1])

    def look(self, *, changed, intruded):
        seen = self.node.measurement(self.now_ns)
        if not changed:
            assert values(seen) == values(self.seen)
        for name in STATES:
            assert (getattr(self.seen, name), getattr(seen, name)) in LEGAL
        assert (seen.bus is BusCondition.INTRUDER) == intruded
        self.seen = seen

    @rule(frame_id=st.integers(0, 0x7FF), data=st.binary(max_size=8))
    def any_frame(self, frame_id, data):
        self.feed(frame_id, data)

    @rule(frame_id=st.sampled_from(INPUT_IDS), data=st.binary(max_size=8))
    def a_broken_input(self, frame_id, data):
        self.feed(frame_id, data)

    @rule(frame_id=st.sampled_from(OWN_IDS), data=st.binary(max_size=8))
    def an_intruder(self, frame_id, data):
        self.feed(frame_id, data)

    @rule(step_ns=st.integers(-(10**12), 10**12) | st.integers(0, 3 * CYCLE_NS))
    def time_passes_as_it_likes(self, step_ns):
        self.now_ns += step_ns
        self.look(changed=False, intruded=False)

    @rule(
        cycles=st.integers(1, 30),
        copies=st.integers(1, 2),
        speed_radps=st.floats(0.0, 600.0),
        lost=st.sets(st.sampled_from(INPUT_IDS)),
    )
    def the_vehicle_speaks(self, cycles, copies, speed_radps, lost):
        signals = VehicleSignals(
            (speed_radps,) * 4, (True,) * 4, (speed_radps,) * 2, (0.0, 0.0), (0.0, 0.0)
        )
        for _ in range(cycles):
            self.now_ns += CYCLE_NS
            self.spoken_ns += CYCLE_NS
            for frame_id, data in self.vehicle.frames(signals, self.spoken_ns):
                for _ in range(0 if frame_id in lost else copies):
                    self.feed(frame_id, data)

    @rule()
    def the_vehicle_starts_anew(self):
        self.vehicle = VehicleNode(DATABASE)

    @rule()
    def enough_good_cycles_make_everything_valid(self):
        self.the_vehicle_speaks(150, 1, 50.0, set())
        assert {getattr(self.seen, name) for name in STATES} == {VALID}

    @rule()
    def enough_silence_makes_everything_that_has_spoken_invalid(self):
        spoken = [name for name in STATES if getattr(self.seen, name) in (VALID, INVALID)]
        self.now_ns += 1_000 * CYCLE_NS
        self.look(changed=False, intruded=False)
        assert {getattr(self.seen, name) for name in spoken} <= {INVALID}

    @invariant()
    def every_number_is_one(self):
        assert all(math.isfinite(value) for pair in values(self.seen) for value in pair)
        assert all(getattr(self.seen, name) >= 0.0 for name in AGES)

    @invariant()
    def what_is_valid_has_been_heard(self):
        for state, age in zip(STATES, AGES, strict=True):
            if getattr(self.seen, state) is VALID:
                assert getattr(self.seen, age) < math.inf


TestAnyFrames = AnyFrames.TestCase
TestAnyFrames.settings = settings(stateful_step_count=30)

"""What a run asks of the system it gives back."""

import gc
import os

from plant_emulator.undisturbed import undisturbed


def test_a_refused_priority_is_no_error_and_everything_is_given_back(monkeypatch):
    asked = []

    def refuse(_pid, policy, parameters):
        asked.append((policy, parameters))
        if policy == os.SCHED_FIFO:
            raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    with undisturbed():
        assert not gc.isenabled()
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0
    assert [policy for policy, _ in asked] == [os.SCHED_FIFO, os.sched_getscheduler(0)]

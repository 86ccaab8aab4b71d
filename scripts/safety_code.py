"""The code that safety rests on and the tests that hold it, for the two checks beside this file."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

FILES = (
    "tcs_hil/canbus/cadence.py",
    "tcs_hil/canbus/ceiling.py",
    "tcs_hil/canbus/codec.py",
    "tcs_hil/canbus/e2e.py",
    "tcs_hil/canbus/e2e_state.py",
    "tcs_hil/canbus/inbox.py",
    "tcs_hil/canbus/outbox.py",
    "tcs_hil/canbus/watch.py",
    "tcs_hil/gate.py",
    "tcs_hil/supervisor.py",
)
TESTS = (
    "tests/canbus/test_any_frames.py",
    "tests/canbus/test_cadence.py",
    "tests/canbus/test_codec.py",
    "tests/canbus/test_e2e.py",
    "tests/canbus/test_e2e_state.py",
    "tests/canbus/test_golden_bytes.py",
    "tests/canbus/test_nodes.py",
    "tests/canbus/test_torque_limits.py",
    "tests/canbus/test_watch.py",
    *sorted(str(path.relative_to(ROOT)) for path in ROOT.glob("tests/test_gate*.py")),
    *sorted(str(path.relative_to(ROOT)) for path in ROOT.glob("tests/test_supervisor*.py")),
)
PYTEST_OPTIONS = ("-q", "-p", "no:cacheprovider", "--hypothesis-profile=brief")

"""`tcs-hil doctor` examines the machine the tests run on, whatever it is like.

In a process of its own, as it takes real-time priority and turns the garbage collector off.
"""

from __future__ import annotations

import json
import subprocess
import sys


def test_every_line_has_a_verdict_and_every_trouble_a_remedy() -> None:
    arguments = ("-m", "tcs_hil", "doctor", "--seconds", "1", "--json")
    ended = subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=False
    )
    findings = json.loads(ended.stdout)
    assert len(findings) == 16
    assert all(finding["found"] for finding in findings)
    assert all(finding["remedy"] for finding in findings if finding["verdict"] != "ok")
    assert ended.returncode == int(any(finding["verdict"] == "fail" for finding in findings))

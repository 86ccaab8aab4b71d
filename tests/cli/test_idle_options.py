"""An option that would change nothing is refused in one sentence, not ignored."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tcs_hil import cli

STUDY = """
scenario = "manoeuvre-1"
vary = [{ key = "road.0.mu", values = [0.3] }]
"""
LOCKSTEP = ("run", "--trigger", "lockstep")


@pytest.mark.parametrize(
    ("arguments", "idle"),
    [
        (("run", "--controller", "nmpc", "--model", "bank.npz"), "--model"),
        (("run", "--trigger", "frame", "--phase-us", "0"), "--phase-us"),
        ((*LOCKSTEP, "--phase-us", "500"), "--phase-us"),
        ((*LOCKSTEP, "--spin-us", "50"), "--spin-us"),
        ((*LOCKSTEP, "--priority", "50"), "--priority"),
        ((*LOCKSTEP, "--cpu", "1"), "--cpu"),
        (("hil", "manoeuvre-1", "--mode", "in-process", "--interface", "virtual"), "--interface"),
        (("hil", "manoeuvre-1", "--bitrate", "500000"), "--bitrate"),
        (("replay", "nowhere", "--interface", "virtual"), "--interface"),
        (("replay", "nowhere", "--live", "--preset", "paper"), "--preset"),
        (("bench", "--only", "tick", "--seconds", "5"), "--seconds"),
        (("monitor", "--flight", "nowhere", "--channel", "can0"), "--channel"),
        (("monitor", "--flight", "nowhere", "--control"), "--control"),
        (("monitor", "--once", "--control"), "--control"),
        (("campaign", "grid.toml", "--points", "5"), "--points"),
        (("campaign", "grid.toml", "--seed", "0"), "--seed"),
        (("campaign", "cube.toml", "--only", "0", "-j", "1"), "--jobs"),
        (("campaign", "cube.toml", "--only", "0", "--scheduler", "tcp://x:1"), "--scheduler"),
        (("campaign", "cube.toml", "--scheduler", "tcp://x:1", "-j", "1"), "--jobs"),
    ],
    ids=" ".join,
)
def test_an_option_without_effect_is_refused_by_name(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    arguments: tuple[str, ...],
    idle: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("cube.toml").write_text(STUDY)
    Path("grid.toml").write_text(f'design = "grid"\n{STUDY}')
    monkeypatch.setattr(sys, "argv", ["tcs-hil", *arguments])
    with pytest.raises(SystemExit) as end:
        cli.main()
    error = capsys.readouterr().err
    assert end.value.code == 2
    assert error.startswith(f"tcs-hil: error: {idle}: has no effect here; ")
    assert error.count("\n") == 1

"""The command line as a user meets it, without a process of its own."""

from __future__ import annotations

import sys

import pytest
from cli.ended import Ended, TcsHil

from tcs_hil import cli


@pytest.fixture
def tcs_hil(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> TcsHil:
    """Run ``tcs-hil`` with these arguments in this process."""

    def run(*arguments: str) -> Ended:
        monkeypatch.setattr(sys, "argv", ["tcs-hil", *arguments])
        with pytest.raises(SystemExit) as end:
            cli.main()
        return Ended(end.value.code, *capsys.readouterr())

    return run

"""Which code runs a law: chosen by one setting, refused where it does not exist."""

from __future__ import annotations

import pytest

from tcs_hil import native
from tcs_hil.control.backend import chosen_backend
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.signals import ControllerKind

KMPC = ControllerKind.KMPC


def settings(backend: str) -> ControlSettings:
    return ControlSettings(preset="paper", backend=backend)


@pytest.fixture(params=[True, False], ids=["built", "not built"])
def built(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> bool:
    monkeypatch.setattr(native, "is_built", lambda: request.param)
    return bool(request.param)


def test_without_a_wish_the_native_step_runs_where_it_was_built(built: bool) -> None:
    assert chosen_backend(KMPC, settings("auto")) == ("native" if built else "python")


def test_python_can_be_asked_for_everywhere(built: bool) -> None:
    assert chosen_backend(KMPC, settings("python")) == "python"


def test_a_native_step_that_was_not_built_is_refused(built: bool) -> None:
    if built:
        assert chosen_backend(KMPC, settings("native")) == "native"
        return
    with pytest.raises(ConfigError, match="no native step was built"):
        chosen_backend(KMPC, settings("native"))


def test_a_law_without_a_native_step_runs_in_python_unless_it_must_not(built: bool) -> None:
    assert chosen_backend(ControllerKind.PI, settings("auto")) == "python"
    with pytest.raises(ConfigError, match="PI of preset paper has no native step"):
        chosen_backend(ControllerKind.PI, settings("native"))

"""From kind to controller, loading no solver that is not used."""

from __future__ import annotations

import subprocess
import sys

import pytest
from needs import needs

from tcs_hil.control.factory import make_controller
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.native import is_built
from tcs_hil.signals import ControllerKind

SOLVERS_LOADED_BY = """
import sys
from tcs_hil.control.factory import make_controller
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind
predictor = KoopmanPredictor.load(default_model_path(), 0.002)
settings = ControlSettings(preset="paper", backend=sys.argv[2])
make_controller(ControllerKind[sys.argv[1]], settings, Vehicle(), predictor)
print(*sorted({"casadi", "daqp", "osqp"} & sys.modules.keys()))
"""


@pytest.mark.parametrize(
    ("kind", "backend", "solvers"),
    [
        ("PI", "auto", ""),
        ("KMPC", "python", "osqp"),
        ("NMPC", "python", "casadi daqp"),
        ("KMPC", "native", ""),
        ("NMPC", "native", ""),
    ],
)
def test_only_the_solvers_in_use_are_imported(kind: str, backend: str, solvers: str) -> None:
    needs(backend == "python" or is_built(), "the native step")
    command = [sys.executable, "-c", SOLVERS_LOADED_BY, kind, backend]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == solvers


def test_kmpc_without_a_model_is_refused() -> None:
    with pytest.raises(ConfigError, match="KMPC needs a model"):
        make_controller(ControllerKind.KMPC, ControlSettings(), Vehicle())


def test_a_model_for_another_period_is_refused(predictor: KoopmanPredictor) -> None:
    settings = ControlSettings(preset="paper", period_s=0.004)
    with pytest.raises(ConfigError, match=r"period_s is 0\.004"):
        make_controller(ControllerKind.KMPC, settings, Vehicle(), predictor)

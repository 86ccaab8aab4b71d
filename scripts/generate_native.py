"""Write the C of the prediction models, from the equations the laws in Python run on.

    python -m scripts.generate_native

To be run after a change of those equations; a test compares what is committed.
Every parameter is an argument of the C, in the order of the structs it comes from.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import casadi as ca

from tcs_hil.control import driveline_transcription as driveline
from tcs_hil.control.driveline import Driveline
from tcs_hil.control.transcription import wheel_rate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4, slip_ratio

SOURCES = Path(__file__).resolve().parent.parent / "tcs_hil" / "native" / "src"


def wheel_model() -> list[Any]:
    """One Runge-Kutta step of [s, omega, e_int], and the slip ratio; both with derivatives."""
    x, torque = ca.SX.sym("x", 3), ca.SX.sym("u")
    step_s: Any = ca.SX.sym("h")
    reference = ca.SX.sym("kappa_ref")
    fields, car = symbolic(Vehicle)
    parameters = ca.vertcat(step_s, reference, fields)
    after = rk4(lambda state: wheel_rate(state, torque, reference, car), x, step_s, substeps=1)
    return [
        step("wheel_step", [x, torque, parameters], after),
        slip("wheel_slip", x, parameters, car),
    ]


def driveline_model() -> list[Any]:
    """One Runge-Kutta step of the default law's state, alone and with derivatives; slip ratio."""
    x, torque = ca.SX.sym("x", driveline.NX), ca.SX.sym("u")
    duration_s, disturbance_n = ca.SX.sym("h"), ca.SX.sym("dF")
    reference = ca.SX.sym("kappa_ref")
    line_fields, line = symbolic(Driveline)
    car_fields, car = symbolic(Vehicle)
    parameters = ca.vertcat(reference, line_fields, car_fields)
    belief: Any = SimpleNamespace(slip_reference=reference, default=SimpleNamespace(driveline=line))
    arguments = [x, torque, ca.vertcat(duration_s, disturbance_n), parameters]
    after = driveline.advance(x, torque, duration_s, disturbance_n, belief, car)
    return [
        function("driveline_flow", arguments, [after]),
        step("driveline_step", arguments, after),
        slip("driveline_slip", x, parameters, car),
    ]


def step(name: str, arguments: list[Any], after: Any) -> Any:
    """A state after a step, and its derivatives by the state before and the torque."""
    x, torque, *_ = arguments
    return function(name, arguments, [after, ca.jacobian(after, ca.vertcat(x, torque))])


def slip(name: str, x: Any, parameters: Any, car: Any) -> Any:
    """The slip ratio, and its derivatives by s and omega."""
    kappa = slip_ratio(x[0], x[1], car)
    return function(name, [x, parameters], [kappa, ca.jacobian(kappa, x[:2])])


def symbolic(struct: Any) -> tuple[Any, Any]:
    """Symbols (n,) for the fields of a struct, and an object with its attributes made of them."""
    names = struct.__struct_fields__
    symbols = ca.SX.sym("p", len(names))
    instance = SimpleNamespace(**dict(zip(names, ca.vertsplit(symbols), strict=True)))
    for name, attribute in vars(struct).items():
        if isinstance(attribute, property) and attribute.fget is not None:
            setattr(instance, name, attribute.fget(instance))
    return symbols, instance


def function(name: str, arguments: list[Any], results: list[Any]) -> Any:
    """A CasADi function with dense results."""
    dense = [ca.densify(result) for result in results]
    return ca.Function(name, arguments, dense, {"cse": True})


MODELS: dict[str, Callable[[], list[Any]]] = {
    "wheel_model": wheel_model,
    "driveline_model": driveline_model,
}


def generate(name: str) -> dict[str, str]:
    """Header and source of a model, by file name."""
    generator = ca.CodeGenerator(name, {"with_header": True})
    for each in MODELS[name]():
        generator.add(each)
    with tempfile.TemporaryDirectory() as folder:
        generator.generate(folder + "/")
        return {path.name: tidy(path.read_text()) for path in sorted(Path(folder).iterdir())}


def tidy(text: str) -> str:
    """Without trailing blanks."""
    return re.sub(r"[ \t]+$", "", text, flags=re.MULTILINE)


def main() -> None:
    """Write every model."""
    for name in MODELS:
        for file, text in generate(name).items():
            (SOURCES / file).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

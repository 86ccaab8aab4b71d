"""Write the C of the prediction models, from the equations the laws in Python run on.

    python -m scripts.generate_native

To be run after a change of those equations; a test compares what is committed.
Every parameter is an argument of the C, in the order of the structs it comes from.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any, NamedTuple

import casadi as ca

from tcs_hil.control import driveline_transcription as driveline
from tcs_hil.control.driveline import Driveline
from tcs_hil.control.transcription import wheel_rate
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle

SOURCES = Path(__file__).resolve().parent.parent / "tcs_hil" / "native" / "src"


class Model(NamedTuple):
    """What a law in C needs of its prediction model."""

    functions: list[Any]  # of CasADi
    slopes: Any  # (nx, nx + 1): derivatives of a step by the state and the torque


def wheel_model() -> Model:
    """The published law's: [s, omega, e_int]; there is no disturbance."""
    x, inputs = ca.SX.sym("x", 3), symbols_of_inputs()
    reference = ca.SX.sym("kappa_ref")
    fields, car = symbolic(Vehicle)
    rate = wheel_rate(x, inputs.torque_nm, reference, car)
    return model("wheel", x, inputs, ca.vertcat(reference, fields), rate, car)


def driveline_model() -> Model:
    """The default law's; disturbed are the tyre's force and the body."""
    x, inputs = ca.SX.sym("x", driveline.NX), symbols_of_inputs()
    reference = ca.SX.sym("kappa_ref")
    line_fields, line = symbolic(Driveline)
    car_fields, car = symbolic(Vehicle)
    parameters = ca.vertcat(reference, line_fields, car_fields)
    belief: Any = SimpleNamespace(slip_reference=reference, default=SimpleNamespace(driveline=line))
    disturbance = inputs.disturbance_n, inputs.disturbance_mps2
    rate = driveline.driveline_rate(x, inputs.torque_nm, disturbance, belief, car)
    return model("driveline", x, inputs, parameters, rate, car)


class Inputs(NamedTuple):
    """What a step is made with."""

    step_s: Any
    torque_nm: Any
    disturbance_n: Any
    disturbance_mps2: Any


def symbols_of_inputs() -> Inputs:
    """A symbol for each."""
    return Inputs(*(ca.SX.sym(name) for name in Inputs._fields))


def model(name: str, x: Any, inputs: Inputs, parameters: Any, rate: Any, car: Any) -> Model:
    """A Runge-Kutta step, alone and with its derivatives, and the slip ratio with its own.

    What parameters alone decide is folded into constants, which are made once.
    """
    after, slopes = runge_kutta(x, inputs, parameters, rate)
    both = ca.cse(ca.vertcat(after, *slopes.nonzeros()))
    both, symbols, folded = ca.extract_parametric(both, parameters)
    after, nonzeros = both[: x.numel()], both[x.numel() :]
    given = [x, ca.vertcat(*inputs), parameters, ca.vertcat(*symbols)]
    kappa = slip_ratio(x[0], x[1], car)
    functions = [
        function(f"{name}_fold", [parameters], [ca.vertcat(*folded)]),
        function(f"{name}_flow", given, [after]),
        function(f"{name}_step", given, [after, nonzeros]),
        function(f"{name}_slip", [x, parameters], [kappa, ca.jacobian(kappa, x[:2])]),
    ]
    return Model(functions, slopes)


def runge_kutta(x: Any, inputs: Inputs, parameters: Any, rate: Any) -> tuple[Any, Any]:
    """State (nx,) after a step of `tcs_hil.model.tyre.rk4`, and its derivatives (nx, nx + 1).

    They go through the same stages as the state: to differentiate the whole step
    backwards would take twice the divisions.
    """
    arguments = [*inputs[1:], parameters]
    variables = ca.vertcat(x, inputs.torque_nm)
    stage = ca.Function("stage", [x, *arguments], [rate, ca.jacobian(rate, variables)])
    start, torque = ca.jacobian(x, variables), ca.jacobian(inputs.torque_nm, variables)

    def change(step_s: Any, reach: Any, slopes: Any) -> tuple[Any, Any]:
        its_rate, by_variables = stage.call([x + reach, *arguments], True, False)
        return step_s * its_rate, (step_s * by_variables) @ ca.vertcat(start + slopes, torque)

    half_s = inputs.step_s / 2.0
    first = change(half_s, 0.0, 0.0)
    second = change(half_s, *first)
    third = change(inputs.step_s, *second)
    fourth = change(half_s, *third)
    total, slopes = (
        (a + 2.0 * b + c + d) * (1.0 / 3.0)
        for a, b, c, d in zip(first, second, third, fourth, strict=True)
    )
    return x + total, ca.sparsify(start + slopes)


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


MODELS: dict[str, Callable[[], Model]] = {"wheel": wheel_model, "driveline": driveline_model}

ARGUMENTS = {
    "fold": (("parameters",), ("constants",)),
    "flow": (("x", "inputs", "parameters", "constants"), ("after",)),
    "step": (("x", "inputs", "parameters", "constants"), ("after", "slopes")),
    "slip": (("x", "parameters"), ("kappa", "by_state")),
}
"""What goes into the functions and what comes out, by the second half of their names."""

ORIGIN = "/* Written by scripts/generate_native.py; what it computes was written by CasADi. */"

HEADER = """{origin}

#ifndef TCS_{guard}_MODEL_H
#define TCS_{guard}_MODEL_H

#include "shooting.h"

enum {{ {guard}_PARAMETERS = {parameters}, {guard}_CONSTANTS = {constants} }};

{prototypes}

#endif
"""

SOURCE = """{origin}

#include "{name}_model.h"

#include <math.h>

static double squared(double x) {{ return x * x; }}

{bodies}
"""

CHAIN = """void {name}_chain(const double *a, int count, by_variables *slope) {{
    for (int j = 0; j < count; j++) {{
{columns}
    }}
{seeds}
}}"""


def source(name: str, model: Model) -> str:
    """C of a model's functions."""
    bodies = [f"{prototype(each)} {{\n{body(each)}\n}}" for each in model.functions]
    bodies.append(chain(name, model.slopes))
    return SOURCE.format(origin=ORIGIN, name=name, bodies="\n\n".join(bodies))


def header(name: str, model: Model) -> str:
    """Their declarations."""
    lines = [f"{prototype(each)};" for each in model.functions] + [f"model_chain {name}_chain;"]
    fold = model.functions[0]
    return HEADER.format(
        origin=ORIGIN,
        guard=name.upper(),
        parameters=fold.numel_in(0),
        constants=fold.numel_out(0),
        prototypes="\n".join(lines),
    )


def prototype(function: Any) -> str:
    """How one of the functions is declared."""
    given, made = names_of(function)
    arguments = [f"const double *restrict {name}" for name in given]
    arguments += [f"double *restrict {name}" for name in made]
    indent = ",\n" + " " * (len(function.name()) + 6)
    return f"void {function.name()}({indent.join(arguments)})"


def names_of(function: Any) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Of its arguments and of its results."""
    return ARGUMENTS[function.name().rpartition("_")[2]]


def body(function: Any) -> str:
    """The statements that CasADi writes, without the null pointers its callers may pass."""
    with TemporaryDirectory() as folder:
        generator = ca.CodeGenerator("one")
        generator.add(function)
        text = Path(generator.generate(folder + "/")).read_text()
    found = re.search(r"static int casadi_f0\(.*?\) {\n(.*?)  return 0;", text, re.DOTALL)
    given, made = names_of(function)
    lines = (
        (found[1] if found else text)
        .replace("casadi_real", "double")
        .replace("casadi_sq", "squared")
    )
    lines = re.sub(
        r"arg\[(\d)\]\? arg\[\d\](\[\d+\]) : 0", lambda m: given[int(m[1])] + m[2], lines
    )
    lines = re.sub(r"if \(res\[(\d)\]!=0\) res\[\d\]", lambda m: made[int(m[1])], lines)
    if unknown := re.search(r"casadi_\w+|\barg\b|\bres\b", lines):
        raise ValueError(f"CasADi writes '{unknown[0]}', which scripts/generate_native cannot read")
    return re.sub(r"^ +", "    ", lines, flags=re.MULTILINE).rstrip()


def chain(name: str, slopes: Any) -> str:
    """C that multiplies derivatives (nx, count) by those of a step; the last are by its torque."""
    nx, sparsity = slopes.size1(), slopes.sparsity()
    places = list(enumerate(zip(sparsity.row(), sparsity.get_col(), strict=True)))
    lines = [f"const double s{row} = slope[{row}][j];" for row in range(nx)]
    for row in range(nx):
        terms = [f"a[{place}] * s{j}" for place, (i, j) in places if i == row and j < nx]
        lines.append(f"slope[{row}][j] = {' + '.join(terms)};")
    seeds = [f"slope[{row}][count - 1] += a[{place}];" for place, (row, j) in places if j == nx]
    return CHAIN.format(name=name, columns=indented(lines, 8), seeds=indented(seeds, 4))


def indented(lines: list[str], by: int) -> str:
    """One text."""
    return "\n".join(" " * by + line for line in lines)


def generate(name: str) -> dict[str, str]:
    """Header and source of a model, by file name."""
    made = MODELS[name]()
    return {f"{name}_model.h": header(name, made), f"{name}_model.c": source(name, made)}


def main() -> None:
    """Write every model."""
    for name in MODELS:
        for file, text in generate(name).items():
            (SOURCES / file).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

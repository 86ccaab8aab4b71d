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
from typing import Any, NamedTuple

import casadi as ca

from tcs_hil.control import driveline_transcription as driveline
from tcs_hil.control.driveline import Driveline
from tcs_hil.control.transcription import wheel_rate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import slip_ratio

SOURCES = Path(__file__).resolve().parent.parent / "tcs_hil" / "native" / "src"


class Model(NamedTuple):
    """What a law in C needs of its prediction model."""

    functions: list[Any]  # of CasADi
    slopes: Any  # (nx, nx + 1): derivatives of the rate by the state and the torque


def wheel_model() -> Model:
    """The published law's: [s, omega, e_int]."""
    x, torque = ca.SX.sym("x", 3), ca.SX.sym("u")
    reference = ca.SX.sym("kappa_ref")
    fields, car = symbolic(Vehicle)
    parameters = ca.vertcat(reference, fields)
    return model("wheel", x, [torque], parameters, wheel_rate(x, torque, reference, car), car)


def driveline_model() -> Model:
    """The default law's; the disturbance of the tyre's force is an argument of its own."""
    x, torque = ca.SX.sym("x", driveline.NX), ca.SX.sym("u")
    disturbance_n = ca.SX.sym("dF")
    reference = ca.SX.sym("kappa_ref")
    line_fields, line = symbolic(Driveline)
    car_fields, car = symbolic(Vehicle)
    parameters = ca.vertcat(reference, line_fields, car_fields)
    belief: Any = SimpleNamespace(slip_reference=reference, default=SimpleNamespace(driveline=line))
    rate = driveline.driveline_rate(x, torque, disturbance_n, belief, car)
    return model("driveline", x, [torque, disturbance_n], parameters, rate, car)


def model(name: str, x: Any, inputs: list[Any], parameters: Any, rate: Any, car: Any) -> Model:
    """The rate, with the nonzero derivatives column by column, and the slip ratio with its own.

    What parameters alone decide is folded into constants, which are made once.
    """
    nx, slopes = x.numel(), ca.jacobian(rate, ca.vertcat(x, inputs[0]))
    both = ca.cse(ca.vertcat(ca.densify(rate), *slopes.nonzeros()))
    both, symbols, folded = ca.extract_parametric(both, parameters)
    arguments = [x, *inputs, parameters, ca.vertcat(*symbols)]
    kappa = slip_ratio(x[0], x[1], car)
    functions = [
        function(f"{name}_fold", [parameters], [ca.vertcat(*folded)]),
        function(f"{name}_rate", arguments, [both[:nx], both[nx:]]),
        function(f"{name}_slip", [x, parameters], [kappa, ca.jacobian(kappa, x[:2])]),
    ]
    return Model(functions, slopes)


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

CHAIN = """/* Written by scripts/generate_native.py from the sparsity of the model's derivatives. */

#include "shooting.h"

void {name}_chain(const double *a, int count, const stage *of) {{
    const double weight = of->weight, reach = of->reach;
    const by_torques *before = of->before, *at = of->at, *sum = of->sum;
    const double *torque = of->torque;
    by_torques *next = of->next, *total = of->total;
#pragma GCC ivdep /* at may be next, and sum total, but no column another */
    for (int j = 0; j < count; j++) {{
{columns}
    }}
}}
"""


def chain(name: str, slopes: Any) -> str:
    """C of one stage of a Runge-Kutta step for the derivatives S by every torque: A S + B."""
    nx, sparsity = slopes.size1(), slopes.sparsity()
    places = list(enumerate(zip(sparsity.row(), sparsity.get_col(), strict=True)))
    read = sorted({column for _, (_, column) in places})
    rows = {column: f"at[{column}]" for column in range(nx)} | {nx: "torque"}
    lines = [f"const double s{column} = {rows[column]}[j];" for column in read]
    for row in range(nx):
        terms = [f"a[{place}] * s{j}" for place, (i, j) in places if i == row]
        lines.append(f"const double d{row} = {' + '.join(terms)};")
    for row in range(nx):
        lines.append(f"total[{row}][j] = sum[{row}][j] + weight * d{row};")
        lines.append(f"next[{row}][j] = before[{row}][j] + reach * d{row};")
    return CHAIN.format(name=name, columns="\n".join(" " * 8 + line for line in lines))


def generate(name: str) -> dict[str, str]:
    """Headers and sources of a model, by file name."""
    functions, slopes = MODELS[name]()
    generator = ca.CodeGenerator(f"{name}_model", {"with_header": True})
    for each in functions:
        generator.add(each)
    with tempfile.TemporaryDirectory() as folder:
        generator.generate(folder + "/")
        written = {path.name: tidy(path.read_text()) for path in sorted(Path(folder).iterdir())}
    return written | {f"{name}_chain.c": chain(name, slopes)}


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

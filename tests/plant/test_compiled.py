"""The seam to the compiler."""

import subprocess
import sys
from typing import NamedTuple

import numpy as np

from plant_emulator.bounds import Table
from plant_emulator.compiled import compiled, opened, records


class Inner(Table, frozen=True):
    b: float = 2.0


class Outer(Table, frozen=True):
    a: float = 1.0
    inner: Inner = Inner()
    n: int = 3
    on: bool = True


@compiled
def total(outers):
    outer = outers[0]
    return outer.a + outer.inner.b * outer.n if outer.on else 0.0


def test_compiled_code_reads_nested_structs_by_their_names():
    assert total(records(Outer())) == 7.0
    assert total(records(Outer(on=False))) == 0.0


class Memory(NamedTuple):
    settings: Outer
    values: np.ndarray


@compiled
def scale(memories):
    memory = memories[0]
    for i in range(memory.values.size):
        memory.values[i] *= memory.settings.inner.b


def test_compiled_code_and_python_share_the_arrays_of_a_record():
    values = np.array([1.0, 2.0, 3.0])
    memory = records(Memory(Outer(), values))
    seen = opened(memory).values
    scale(memory)
    assert seen.tolist() == [2.0, 4.0, 6.0]
    assert values.tolist() == [1.0, 2.0, 3.0]


def test_division_by_zero_is_infinite_and_no_error():
    @compiled
    def divide(a, b):
        return a / b

    assert divide(1.0, 0.0) == np.inf


def test_the_service_never_loads_the_compiler():
    code = "import sys, tcs_hil.cli; sys.exit('numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

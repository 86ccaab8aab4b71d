"""What is compiled when the package is installed, which pyproject.toml cannot say.

The laws' steps are C, built by cffi.  The rest of a tick is compiled by mypyc from the Python that
runs where there is no compiler; not in an editable installation, in which a changed file must be a
changed program.  TCS_HIL_INTERPRETED=1 leaves it out anywhere.
"""

import os
import sys

from setuptools import setup

# Behaviour only.  mypyc loses the options of a msgspec struct, so settings and signals are not
# here; numba wants the bytecode of what it compiles itself, so the plant's equations are not; and
# a single call into C (control/native_law.py) is quicker from the interpreter.
TICK = {
    "tcs_hil": "gate pipeline supervisor",
    "tcs_hil/canbus": "cadence ceiling e2e e2e_state inbox outbox service_node tcs_node"
    " vehicle_node watch",
    "tcs_hil/canbus/mapping": "node",
    "tcs_hil/control": "bank_kmpc body_disturbance break_away carried_force compensated"
    " driveline_nmpc entry fallback force_disturbance friction_rise guarded integrator"
    " native_bank native_driveline pi plan screening sent speed_disturbance swing_guard swings",
    "tcs_hil/estimator": "body_speed direct driveline_observer edge_age friction fused held"
    " loop_delay side",
    "tcs_hil/model": "tyre",
    "tcs_hil/plausibility": "driven rolling screen trace",
    "tcs_hil/runtime": "clock lockstep loop record recorder stopwatch transitions trigger",
    "tcs_hil/hil": "busless simulation",
    "tcs_hil/hil/metrics": "ideal ideal_car",
    "plant_emulator": "emulator limit_keeper link pedal plant plant_faults recording sensor_set"
    " virtual_bus",
}


def compiled_tick():
    """Extensions of the tick's modules; a compiler that fails leaves them interpreted."""
    builds = {"bdist_wheel", "build_ext"} & set(sys.argv)  # metadata alone need no compiler
    if not builds or os.environ.get("TCS_HIL_INTERPRETED"):
        return []
    from mypyc.build import mypycify  # noqa: PLC0415 - only where it is used

    files = [f"{room}/{name}.py" for room, names in TICK.items() for name in names.split()]
    # Without our own settings of mypy: an isolated build has none of our dependencies' types.
    extensions = mypycify(
        ["--config-file=", "--ignore-missing-imports", *files],
        opt_level="3",
        debug_level="0",
        group_name="tcs_hil_tick",
    )
    for extension in extensions:
        extension.optional = True
    return extensions


setup(cffi_modules=["tcs_hil/native/build.py:ffibuilder"], ext_modules=compiled_tick())

"""How the native step is compiled: sources, and the part of them that Python sees.

Run by ``setup.py`` when the package is installed, never by the package itself.
"""

from pathlib import Path
from runpy import run_path

from cffi import FFI

ROOM = Path("tcs_hil") / "native"  # relative, as setuptools wants its sources
HEADERS = ("kmpc", "nmpc", "bank", "driveline")
SOURCES = (
    "box_qp",
    "lifting",
    "wheel_state",
    "kmpc",
    "least_squares",
    "shooting",
    "sqp",
    "nmpc",
    "wheel_model",
    "observables",
    "bank",
    "driveline",
    "driveline_model",
)

checksum = run_path(str(ROOM / "sources.py"))["checksum"](ROOM)
preamble = [f"static const unsigned sources_checksum = {checksum}u;"]
preamble += [f'#include "{name}.h"' for name in HEADERS]

ffibuilder = FFI()
ffibuilder.cdef((ROOM / "interface.h").read_text(encoding="utf-8"))
ffibuilder.set_source(
    "tcs_hil.native._core",
    "\n".join(preamble),
    sources=[str(ROOM / "src" / f"{name}.c") for name in SOURCES],
    depends=[str(path) for path in sorted((ROOM / "src").glob("*.h"))],
    include_dirs=[str(ROOM / "src")],
    extra_compile_args=[
        "-std=c11",
        "-O3",
        "-fno-math-errno",
        "-freciprocal-math",
        "-ffp-contract=off",
    ],
    optional=True,  # without a compiler the laws run in Python
)

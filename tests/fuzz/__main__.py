"""Coverage-guided fuzzing of one target with atheris (libFuzzer).

    python -m tests.fuzz TARGET [LIBFUZZER-OPTION...] [NEW_INPUTS_FOLDER]

Run it from the top of the project.  The kept corpus is where it starts; new
inputs go into the folder named last, if any.  A finding ends it with a stack trace and a
file ``crash-*`` to be kept in the corpus once it is mended.
"""

from __future__ import annotations

import sys
from pathlib import Path

import atheris

OURS = ["tcs_hil", "plant_emulator"]
PARSERS = ["tomllib", "textparser", "cantools", "can", "zipfile"]  # what ours leave to others
with atheris.instrument_imports(include=[*OURS, *PARSERS]):
    from .targets import TARGETS

CORPUS = Path(__file__).with_name("corpus")


def main() -> None:
    """Fuzz until libFuzzer's own limits say so."""
    if len(sys.argv) < 2 or sys.argv[1] not in TARGETS:
        sys.exit(f"usage: python -m tests.fuzz {{{','.join(TARGETS)}}} [LIBFUZZER-OPTION...]")
    name, options = sys.argv[1], sys.argv[2:]
    folders = [option for option in options if not option.startswith("-")]
    flags = [option for option in options if option.startswith("-")]
    atheris.Setup(["fuzz", *flags, *folders, str(CORPUS / name)], TARGETS[name])
    atheris.Fuzz()


main()

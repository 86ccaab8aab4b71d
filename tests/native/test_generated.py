"""The committed C of the prediction models is what their equations give today."""

from __future__ import annotations

import re

import pytest

from scripts.generate_native import MODELS, SOURCES, generate


@pytest.mark.parametrize("name", MODELS)
def test_generating_it_again_changes_nothing(name: str) -> None:
    for file, text in generate(name).items():
        assert (SOURCES / file).read_text(encoding="utf-8") == text, (
            "run python -m scripts.generate_native"
        )


@pytest.mark.parametrize(("name", "header"), [("wheel", "nmpc.h"), ("driveline", "driveline.h")])
def test_the_structs_have_room_for_what_the_model_takes(name: str, header: str) -> None:
    fold = MODELS[name]().functions[0]
    sizes = re.findall(r"_(PARAMETERS|CONSTANTS) = (\d+)", (SOURCES / header).read_text())
    assert dict(sizes) == {
        "PARAMETERS": str(fold.numel_in(0)),
        "CONSTANTS": str(fold.numel_out(0)),
    }

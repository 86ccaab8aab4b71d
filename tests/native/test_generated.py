"""The committed C of the prediction models is what their equations give today."""

from __future__ import annotations

import pytest

from scripts.generate_native import MODELS, SOURCES, generate


@pytest.mark.parametrize("name", MODELS)
def test_generating_it_again_changes_nothing(name: str) -> None:
    for file, text in generate(name).items():
        assert (SOURCES / file).read_text(encoding="utf-8") == text, (
            "run python -m scripts.generate_native"
        )

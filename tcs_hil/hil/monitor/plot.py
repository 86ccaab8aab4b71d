"""Curves in Braille dots: two columns and four rows of them in every character."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from rich.text import Text

DOTS = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))
"""Bit of a dot by column and row, top row first (Unicode, block Braille Patterns)."""
BRAILLE = 0x2800
LABEL_WIDTH = 5


class Curve(NamedTuple):
    """Values by column of dots, the newest last, and how they look; None leaves a gap."""

    values: Sequence[float | None]
    style: str
    dashed: bool = False


class Canvas:
    """A grid of characters; where curves share a character, the later one gives the colour."""

    def __init__(self, width: int, height: int, top: float) -> None:
        self._width, self._height, self._top = width, height, top
        self._bits = [[0] * width for _ in range(height)]
        self._styles = [[""] * width for _ in range(height)]

    def draw(self, curve: Curve) -> None:
        """Draw a curve that ends at the right edge."""
        columns = 2 * self._width
        values = [*[None] * columns, *curve.values][-columns:]
        for column, (before, value) in enumerate(pairwise([None, *values])):
            if value is None or (curve.dashed and column % 4 > 1):
                continue
            row = self._row(value)
            start = row if before is None or curve.dashed else self._row(before)
            for between in range(min(start, row), max(start, row) + 1):
                self._dot(column, between, curve.style)

    def lines(self) -> list[Text]:
        """The rows from the top, the scale at their left."""
        lines = []
        for row, (bits, styles) in enumerate(zip(self._bits, self._styles, strict=True)):
            line = Text.assemble((self._label(row), "dim"))
            for cell, style in zip(bits, styles, strict=True):
                line.append(chr(BRAILLE + cell), style)
            lines.append(line)
        return lines

    def _row(self, value: float) -> int:
        rows = 4 * self._height
        share = min(max(value / self._top, 0.0), 1.0)
        return round((1.0 - share) * (rows - 1))

    def _dot(self, column: int, row: int, style: str) -> None:
        self._bits[row // 4][column // 2] |= DOTS[column % 2][row % 4]
        self._styles[row // 4][column // 2] = style

    def _label(self, row: int) -> str:
        if row not in (0, self._height - 1):
            return " " * LABEL_WIDTH
        return f"{self._top if row == 0 else 0:>{LABEL_WIDTH - 1}.4g} "


def plot(curves: Sequence[Curve], width: int, height: int, top: float) -> Text:
    """Draw ``curves`` from zero to ``top`` on ``width`` x ``height`` characters, scale included."""
    canvas = Canvas(max(width - LABEL_WIDTH, 1), max(height, 1), top)
    for curve in curves:
        canvas.draw(curve)
    return Text("\n").join(canvas.lines())

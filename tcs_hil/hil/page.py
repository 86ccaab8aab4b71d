"""The demo as one self-contained HTML page."""

from __future__ import annotations

import base64
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from tcs_hil.hil.demo import Demo
from tcs_hil.hil.machine import describe_machine
from tcs_hil.hil.table import COLUMNS, row


def write_page(path: Path, demo: Demo) -> None:
    """Write table and figures into ``path``; the figures are inside, so it can be sent alone."""
    environment = Environment(
        loader=PackageLoader("tcs_hil.hil", "."), autoescape=True, undefined=StrictUndefined
    )
    page = environment.get_template("page.html.j2").render(
        bus=demo.bus,
        machine=describe_machine(),
        figures={title: _inline(image) for title, image in demo.figures.items()},
        headings=list(COLUMNS),
        rows=[row(outcome) for outcome in demo.outcomes],
    )
    path.write_text(page, encoding="utf-8")


def _inline(image: Path) -> str:
    return base64.b64encode(image.read_bytes()).decode()

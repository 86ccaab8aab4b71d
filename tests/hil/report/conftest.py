"""The page in a real browser: loud where there is none, an error in CI."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hil.report.browser import program

MISSING = "there is no chromium (apt-get install chromium)"


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    needy = [item for item in items if item.path == Path(__file__).with_name("test_browser.py")]
    if not needy or program() is not None:
        return
    if os.environ.get("CI") == "true":
        raise pytest.UsageError(f"CI must look at the report in a browser, but {MISSING}")
    for item in needy:
        item.add_marker(pytest.mark.skip(reason=MISSING))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if program() is None:
        line = f"NOBODY LOOKED AT THE REPORT: {MISSING}"
        terminalreporter.write_sep("!", line, red=True, bold=True)

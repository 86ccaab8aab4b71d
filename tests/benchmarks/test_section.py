import sys
from pathlib import Path

import pytest

from benchmarks.section import markdown, write_section

BEGIN, END = "<!-- begin benchmarks.x -->", "<!-- end benchmarks.x -->"


def test_a_new_page_is_the_section_and_says_what_made_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["control.py", "--quick"])
    page = tmp_path / "page.md"
    write_section(page, "benchmarks.x", ["| 1 |"])
    text = page.read_text()
    assert text.startswith(BEGIN)
    assert text.endswith(f"| 1 |\n{END}\n")
    assert "python -m benchmarks.x --quick" in text


def test_only_the_section_is_replaced_when_it_is_made_again(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"# By hand\n\n{BEGIN}\nold\n{END}\n\nMore by hand.\n")
    write_section(page, "benchmarks.x", ["new"])
    text = page.read_text()
    assert text.startswith(f"# By hand\n\n{BEGIN}\n")
    assert text.endswith(f"new\n{END}\n\nMore by hand.\n")
    assert "old" not in text


def test_a_second_section_goes_below_what_is_there(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# By hand\n")
    write_section(page, "benchmarks.x", ["one"])
    write_section(page, "benchmarks.y", ["two"])
    write_section(page, "benchmarks.x", ["three"])
    text = page.read_text()
    assert text.startswith("# By hand\n\n<!-- begin benchmarks.x")
    assert text.index("three") < text.index("two")
    assert "one\n" not in text


def test_a_part_of_a_benchmark_has_a_section_of_its_own(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    write_section(page, "benchmarks.x", ["whole"])
    write_section(page, "benchmarks.x", ["old"], part="vcan0")
    write_section(page, "benchmarks.x", ["part"], part="vcan0")
    text = page.read_text()
    assert "whole" in text
    assert "<!-- begin benchmarks.x vcan0 -->" in text
    assert "old" not in text


def test_a_table_lines_figures_up_to_the_right() -> None:
    assert markdown(["a", "b"], [["x", "1"]]) == ["| a | b |", "| --- | --: |", "| x | 1 |"]

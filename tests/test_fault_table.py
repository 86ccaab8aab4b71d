from pathlib import Path

from tcs_hil.fault_codes import FaultCode
from tcs_hil.fault_table import markdown_table

SAFETY = Path(__file__).parents[1] / "docs" / "safety.md"


def test_every_code_but_none_has_a_row_in_the_order_of_the_numbers() -> None:
    rows = markdown_table().splitlines()[2:]
    codes = sorted(set(FaultCode) - {FaultCode.NONE})
    assert [row.split("|")[1:3] for row in rows] == [[f" {c} ", f" `{c.name}` "] for c in codes]


def test_a_row_tells_meaning_state_reaction_and_time() -> None:
    assert (
        "| 86 | `BUS_INTRUDER` | somebody else sends what only the service may send "
        "| FAULT | ramp to the driver's request, then none | 1 tick |"
    ) in markdown_table()
    assert "| DEGRADED | may fall, do not rise | 3rd missing cycle, 6 ms |" in markdown_table()


def test_the_documentation_shows_the_table_of_the_rules_as_it_is() -> None:
    assert markdown_table() in SAFETY.read_text(encoding="utf-8")

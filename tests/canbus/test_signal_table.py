from pathlib import Path

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.canbus.signal_table import markdown_table

README = Path(__file__).parents[2] / "README.md"


def test_every_signal_but_crc_and_counter_has_a_row() -> None:
    _, database = parse_dbc()
    table = markdown_table(database)
    for message in database.messages:
        for signal in message.signals:
            hidden = signal.name in (f"{message.name}Crc", f"{message.name}Counter")
            assert (f"| `{signal.name}` |" in table) != hidden


def test_the_readme_shows_the_table_of_the_dbc_as_it_is() -> None:
    assert markdown_table(parse_dbc()[1]) in README.read_text(encoding="utf-8")

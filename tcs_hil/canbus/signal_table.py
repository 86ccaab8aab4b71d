"""The contract of the bus as a Markdown table, from the DBC alone."""

from __future__ import annotations

from cantools.database.can import Database, Message, Signal

HEADER = (
    "| message | id | cycle | from | signal | unit | range | resolution | meaning |",
    "|---|---|---|---|---|---|---|---|---|",
)


def markdown_table(database: Database) -> str:
    """One row per signal; the CRC and counter of protected messages are left out."""
    rows = [
        _row(message, signal, first)
        for message in sorted(database.messages, key=lambda message: message.frame_id)
        for first, signal in _numbered(message)
    ]
    return "\n".join((*HEADER, *rows))


def _numbered(message: Message) -> list[tuple[bool, Signal]]:
    protection = (f"{message.name}Crc", f"{message.name}Counter")
    shown = [signal for signal in message.signals if signal.name not in protection]
    return [(position == 0, signal) for position, signal in enumerate(shown)]


def _row(message: Message, signal: Signal, first: bool) -> str:
    about = (
        f"`{message.name}`" if first else "",
        f"0x{message.frame_id:03X}" if first else "",
        (f"{message.cycle_time} ms" if message.cycle_time else "event") if first else "",
        ", ".join(message.senders) if first else "",
        f"`{signal.name}`",
        signal.unit or "",
        _range(signal),
        f"{signal.scale:g}",
        signal.comment or "",
    )
    return f"| {' | '.join(about)} |"


def _range(signal: Signal) -> str:
    if signal.minimum is None or signal.maximum is None:
        return ""
    return f"{signal.minimum:g} … {signal.maximum:g}"

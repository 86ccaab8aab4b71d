"""The one root of everything this package raises on purpose.

A message is one sentence that names the culprit (file, message, signal or
option); the command line prints it as it is and exits with status 2.
"""

from collections.abc import Iterable
from difflib import get_close_matches

MOST_OFFERED = 40
"""More names than that are no help in a sentence."""


class TcsError(Exception):
    """Something the user can mend: input, configuration or environment."""


class ConfigError(TcsError):
    """A configuration, scenario or option is unknown, missing or out of range."""


class DatabaseError(TcsError):
    """The DBC is malformed or lacks something the service needs."""


class ModelError(TcsError):
    """A model file cannot be used: damaged, incomplete or made for another period."""


class BusError(TcsError):
    """The CAN interface cannot be opened or has been lost."""


def offer(name: str, known: Iterable[str]) -> str:
    """How a sentence on an unknown name goes on: the nearest ones, or all if they are few."""
    by_lower = {each.lower(): each for each in known}
    near = [by_lower[each] for each in get_close_matches(name.lower(), by_lower, n=3)]
    if near:
        return f"; did you mean {' or '.join(near)}?"
    return f"; there are {', '.join(by_lower.values())}" if len(by_lower) <= MOST_OFFERED else ""

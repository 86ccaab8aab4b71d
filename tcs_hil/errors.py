"""The one root of everything this package raises on purpose.

A message is one sentence that names the culprit (file, message, signal or
option); the command line prints it as it is and exits with status 2.
"""


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

"""How both programs meet the user: errors in one sentence, exit status 2."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Mapping
from typing import Any

import click

from tcs_hil.errors import ConfigError, TcsError
from tcs_hil.loading import INTERRUPTED

USER_ERROR = 2


class Name(click.types.StringParamType):
    """Text that is not empty: an empty name is a script's unset variable, not a wish."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Refuse what has no letter in it."""
        text: str = super().convert(value, param, ctx)
        if not text.strip():
            self.fail("is empty", param, ctx)
        return text


class FiniteRange(click.FloatRange):
    """A number within bounds; nan, which is within all of them, and infinity are none."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Refuse what the bounds let through."""
        number: float = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value} is not a finite number", param, ctx)
        return number


NAME = Name()


def refuse(options: Mapping[str, Any], names: Iterable[str], why: str) -> None:
    """Refuse options that were given and would change nothing: silence would mislead.

    Raises:
        ConfigError: one of ``names`` was given; it is named.
    """
    for name in names:
        value = options[name]
        if not (value is None or value is False or value == ()):  # 0 was said, too
            raise ConfigError(f"--{name.replace('_', '-')}: has no effect here; {why}")


def counted(count: int, what: str) -> str:
    """``1 case``, ``2 cases``."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def run(command: click.Command, program: str) -> int:
    """Run a click command line and return its exit status.

    What the user can mend ends as one sentence on stderr with status 2, never
    as a traceback; anything else is our bug and is shown in full.
    """
    try:
        status = command.main(prog_name=program, standalone_mode=False)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return USER_ERROR
    except (TcsError, click.ClickException) as error:
        sentence = error.format_message() if isinstance(error, click.ClickException) else str(error)
        print(f"{program}: error: {sentence}", file=sys.stderr)
        return USER_ERROR
    except BrokenPipeError:
        return 0  # the reader has seen enough
    except OSError as error:  # a disk or a device, not our code
        print(f"{program}: error: {error}", file=sys.stderr)
        return USER_ERROR
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    return status if isinstance(status, int) else 0

"""How both programs meet the user: errors in one sentence, exit status 2."""

from __future__ import annotations

import sys

import click

from tcs_hil.errors import TcsError

USER_ERROR = 2
INTERRUPTED = 130


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

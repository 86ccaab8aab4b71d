"""What the host asks of the guest: files in one folder that both can see."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path

STDOUT, STDERR, READY, STATUS = "stdout", "stderr", "ready", "status"

TIMED_OUT = 124
NO_PLACE = 125  # no vcan0 could be had, so the command never ran
NOT_EXECUTABLE = 126
NOT_FOUND = 127

_FILE = "job.json"


@dataclass(frozen=True)
class Job:
    """A command, where it runs, and what of the host it may change.

    Attributes:
        argv: the command and its arguments.
        cwd: the folder it starts in.
        env: its whole environment.
        writable: folders whose changes reach the host.
        modules: folder of the guest kernel's loadable modules; None where all is built in.
    """

    argv: list[str]
    cwd: str
    env: dict[str, str]
    writable: list[str]
    modules: str | None

    def save(self, folder: Path) -> None:
        """Write the job into the shared folder."""
        (folder / _FILE).write_text(json.dumps(asdict(self)))


def load(folder: Path) -> Job:
    """Read the job that `Job.save` left in the folder."""
    return Job(**json.loads((folder / _FILE).read_text()))


def execute(argv: list[str], env: dict[str, str]) -> int:
    """Become the command, or say why not and return the status a shell would."""
    try:
        os.execvpe(argv[0], argv, env)  # noqa: S606 - no shell is wanted
    except OSError as error:
        os.write(2, f"with-vcan: {argv[0]}: {error.strerror}\n".encode())
        return NOT_FOUND if isinstance(error, FileNotFoundError) else NOT_EXECUTABLE

"""Points spread over the cores of this machine or of a Dask cluster."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager

from tcs_hil.errors import ConfigError
from tcs_hil.hil.processes.interruption import uninterrupted
from tcs_hil.hil.study.design import Point
from tcs_hil.hil.study.plan import Plan
from tcs_hil.hil.study.trial import Row, run

try:
    from distributed import Client, LocalCluster, WorkerPlugin, as_completed
except ImportError as error:
    raise ConfigError("a study needs distributed: pip install 'tcs-hil[bench]'") from error

CONNECT_S = 10
BATCH = 4
"""Points a worker takes at once: enough to hide the way to it, few enough to share evenly."""

Task = tuple[int, Point]


@contextmanager
def workers(scheduler: str | None, processes: int | None) -> Iterator[Client]:
    """A client of the cluster at ``scheduler``, or of one of our own, a process for each core.

    Raises:
        ConfigError: nobody answers there.
    """
    if scheduler is None:
        with ExitStack() as stack:
            with uninterrupted():
                cluster = stack.enter_context(_own(processes))
                client = stack.enter_context(Client(cluster))  # type: ignore[no-untyped-call]
                client.register_plugin(_QuietEnd())
            yield client
        return
    try:
        client = Client(scheduler, timeout=CONNECT_S)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise ConfigError(f"--scheduler {scheduler}: nobody answers ({error})") from error
    with client:
        yield client


def _own(processes: int | None) -> LocalCluster:
    return LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=processes or os.cpu_count(),
        threads_per_worker=1,
        dashboard_address="127.0.0.1:0",  # None would be 8787, which another study may have
        scheduler_kwargs={"dashboard": False},
        silence_logs=40,
    )


class _QuietEnd(WorkerPlugin):
    """For workers of our own: the campaign ends them; they say nothing of it."""

    def setup(self, worker: object) -> None:  # noqa: ARG002 - Dask's signature
        """Dask calls it in each worker, also in those that replace a dead one."""
        logging.getLogger("distributed").setLevel(logging.CRITICAL)


def drive(client: Client, plan: Plan, tasks: Sequence[Task]) -> Iterator[list[Row]]:
    """Rows of the tasks, in batches as they come; a worker that dies has its batch driven again."""
    shared = client.scatter(plan, broadcast=True)  # type: ignore[no-untyped-call]
    batches = [tasks[first : first + BATCH] for first in range(0, len(tasks), BATCH)]
    futures = client.map(run_batch, batches, plan=shared, pure=False, retries=2)
    for future in as_completed(futures):  # type: ignore[no-untyped-call]
        rows: list[Row] = future.result()
        yield rows


def run_batch(tasks: Sequence[Task], plan: Plan) -> list[Row]:
    """What a worker does."""
    return [run(plan, point, index) for index, point in tasks]

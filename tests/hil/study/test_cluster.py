"""On a real Dask scheduler with two workers, one of which is killed."""

import subprocess
import sys
from contextlib import ExitStack, contextmanager

import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study import cluster
from tcs_hil.hil.study.cluster import BATCH, drive, workers
from tcs_hil.hil.study.design import points

READY_S = 120  # two interpreters with all of Dask, on a machine that may be busy


@contextmanager
def program(*arguments):
    """A program of Dask that talks on stderr."""
    dask = [sys.executable, "-m", "dask", *arguments]
    with subprocess.Popen(dask, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


@pytest.fixture
def two_workers():
    """Address of a scheduler, and its two workers."""
    with ExitStack() as stack:
        options = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show")
        scheduler = stack.enter_context(program("scheduler", *options))
        said = next(line for line in scheduler.stderr if "Scheduler at:" in line)
        address = said.split()[-1]
        worker = ("worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
        both = [stack.enter_context(program(*worker, "--name", name)) for name in ("a", "b")]
        yield address, both


def test_a_worker_that_is_killed_costs_no_row(two_workers, plan):
    address, (first, _) = two_workers
    chosen = plan(points=8 * BATCH)
    tasks = list(enumerate(points(chosen.study)))
    with workers(address, None) as client:
        client.wait_for_workers(2, timeout=READY_S)
        batches = drive(client, chosen, tasks)
        rows = next(batches)
        first.kill()
        rows += [row for batch in batches for row in batch]
    assert sorted(row["index"] for row in rows) == list(range(8 * BATCH))
    assert all(row["error"] == "" for row in rows)


def test_a_scheduler_that_is_not_there_is_named(monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)  # a user is given time to start one
    with (
        pytest.raises(ConfigError, match=r"--scheduler tcp:\S+ nobody answers"),
        workers("tcp://127.0.0.1:9", None),
    ):
        pass

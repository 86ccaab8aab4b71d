import subprocess
import sys

CHECK = """
import sys
from tcs_hil.cli import cli
cli.get_command(None, "run")
print(*sorted({"asammdf", "casadi", "matplotlib", "numba", "pandas"} & sys.modules.keys()))
"""


def test_the_daemon_imports_nothing_it_does_not_need():
    ended = subprocess.run(
        [sys.executable, "-c", CHECK], capture_output=True, text=True, check=True
    )
    # The name stays, as a door that is shut.
    assert ended.stdout.split() == ["asammdf"]

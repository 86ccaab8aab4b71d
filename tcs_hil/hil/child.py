"""``python -m tcs_hil.hil.child MODULE ARGUMENT...``: run MODULE, but not longer than the bench.

A bench that is killed outright cannot stop its programs; the kernel can.  Asked
for here and not between fork and exec, where a bench with threads may not run
Python.
"""

from __future__ import annotations

import ctypes
import runpy
import signal
import sys

PR_SET_PDEATHSIG = 1

if __name__ == "__main__":
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)

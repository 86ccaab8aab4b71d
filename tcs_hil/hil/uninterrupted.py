"""For the fork server of a bench, before all else: Ctrl-C is for the bench, which ends the others.

A terminal sends it to every process; one that is still being made would end with
a traceback.  What is forked off inherits this, and ends by SIGTERM.
"""

from __future__ import annotations

import signal

signal.signal(signal.SIGINT, signal.SIG_IGN)

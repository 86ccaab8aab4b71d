"""Entry of the guest that `with-vcan` boots; the kernel runs it as PID 1."""

import sys
from pathlib import Path

from with_vcan.guest import main

main(Path(sys.argv[1]))

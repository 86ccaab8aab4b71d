"""``python -m tcs_hil``: the same as the ``tcs-hil`` command."""

from tcs_hil.cli import main

main()

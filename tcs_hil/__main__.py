"""``python -m tcs_hil``: the same as the ``tcs-hil`` command."""

from tcs_hil.loading import loading


def main() -> None:
    """Entry point of ``tcs-hil``."""
    with loading():
        from tcs_hil.cli import main as command_line  # noqa: PLC0415
    command_line()


if __name__ == "__main__":
    main()

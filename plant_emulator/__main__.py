"""``python -m plant_emulator``: the same as the ``plant-emulator`` command."""

from tcs_hil.loading import loading


def main() -> None:
    """Entry point of ``plant-emulator``."""
    with loading():
        from plant_emulator.cli import main as command_line  # noqa: PLC0415
    command_line()


if __name__ == "__main__":
    main()

"""`python -m plant_emulator` is `plant-emulator`."""

from plant_emulator.cli import main

main()

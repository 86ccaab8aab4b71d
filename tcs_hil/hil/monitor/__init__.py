"""The live view of a bus or of a flight recording, and a hand on a running emulator."""

"""The fault campaign: every fault of the emulator in the middle of slip control, and its judge."""

"""What a run leaves on disk, read back: bus log, flight recording, truth, configuration."""

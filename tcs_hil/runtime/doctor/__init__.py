"""Whether this machine can keep a 2 ms tick, and what would mend it where it cannot."""

"""What the bench starts: programs, workers, and how all of them end."""

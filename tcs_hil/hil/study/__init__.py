"""Parameter studies: a scenario varied over a space, driven on every core or on a cluster."""

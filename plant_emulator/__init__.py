"""The truth: a front-driven electric car on a CAN bus, in a process of its own."""

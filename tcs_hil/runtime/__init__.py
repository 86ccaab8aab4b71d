"""Clock, loop, recorder: everything that touches the operating system."""

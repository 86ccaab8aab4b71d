"""What `tcs-hil bench` measures: laws, whole ticks, their growth, a bus, and the start."""

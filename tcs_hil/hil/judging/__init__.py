"""Limits on a run: what can be measured, under which name, and whether it was kept."""

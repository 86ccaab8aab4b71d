"""The daemon: its configuration, its parts wired together, and its life."""

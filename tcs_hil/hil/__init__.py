"""The bench: starts both processes, records, judges and reports."""

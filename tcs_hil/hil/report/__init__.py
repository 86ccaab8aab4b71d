"""The report: one HTML page per suite, with everything inside it."""

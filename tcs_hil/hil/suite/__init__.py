"""Suites: which cases there are, driving them side by side, and what came of them."""

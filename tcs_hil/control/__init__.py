"""Slip controllers, one instance per driven wheel."""

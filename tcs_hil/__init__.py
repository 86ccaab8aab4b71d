"""Traction control on a CAN bus, and the bench that tests it."""

"""Curves over time and where they lie on the screen; no GPU."""

"""Scenarios of the window: what an artist does, and what is measured meanwhile."""

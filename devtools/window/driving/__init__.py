"""Hands and eyes in a real Blender: mouse, keys, screen, and what is measured meanwhile."""

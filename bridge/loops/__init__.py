"""Loops as actions: one cycle of keys that Blender repeats, and what carries its travel."""

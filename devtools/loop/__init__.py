"""Loops made of recorded runs, as Blender plays them."""

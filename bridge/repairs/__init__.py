"""Repairs of a recording as Blender keeps them: what was found, and what of its remedies counts."""

"""Motion files as plain arrays; no Blender."""

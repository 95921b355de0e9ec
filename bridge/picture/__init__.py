"""The picture of a result: strobe figures with their constraints, rendered in Blender."""

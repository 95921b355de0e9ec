"""What cases are, and what they share: damage to files, and the open file in Blender."""

"""A real Blender's window driven by mouse and keys, and measured."""

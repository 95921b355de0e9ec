"""End-to-end tests of the built extension: a real Blender's window, driven and measured."""

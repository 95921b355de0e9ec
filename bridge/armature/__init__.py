"""Armatures and actions, read and written: poses, channels, F-curves, bone keys."""

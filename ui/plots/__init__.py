"""Curves over time at the foot of the 3D viewport."""

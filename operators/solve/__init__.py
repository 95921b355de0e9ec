"""Analyze, Fit, Adapt, Refine and what becomes of their results; never blocks Blender."""

"""Recipes: a MotionProblem as a TOML text that people write."""

"""The mathematics of Hangtime: numpy and casadi, SI units, Z up; never imports Blender."""

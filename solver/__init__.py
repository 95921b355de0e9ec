"""The mathematics of Hangtime: numpy and CasADi, SI units, Z up; never imports Blender."""

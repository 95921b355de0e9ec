"""Numerical methods: B-splines, rotations, block-banded Cholesky, interpolation, threads."""

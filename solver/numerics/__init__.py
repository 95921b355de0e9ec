"""General numerics: splines, rotations, block-banded factorisation, interpolation."""

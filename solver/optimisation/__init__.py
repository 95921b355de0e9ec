"""Sequential quadratic programming on block-banded problems; no notion of a body."""

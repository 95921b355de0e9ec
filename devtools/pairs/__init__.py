"""Real jumps of one performer, one adapted to another's landing and set beside it."""

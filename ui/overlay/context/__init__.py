"""Context of a redraw, read once, and traced figures cached between redraws."""

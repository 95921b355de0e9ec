"""What a redraw looks at, read once, and what is cached between redraws."""

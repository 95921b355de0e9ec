"""Keys of a result: few Bézier keys instead of one on every frame, within a stated error."""

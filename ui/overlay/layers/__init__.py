"""The layers of the overlay: pins, limits, ghosts, motion, labels."""

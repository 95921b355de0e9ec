"""Where contacts go that the artist moves, and the ground that they land on."""

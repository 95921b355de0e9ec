"""What the artist chooses of results: what they hold, their keys, and whether they repeat."""

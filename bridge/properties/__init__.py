"""What the extension stores in the artist's file, and what keeps it consistent."""

"""What the artist asks for, as constraints and contacts of the problem (thesis 3.3)."""

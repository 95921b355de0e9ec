"""What is kept with an adapted action as text, and read of it."""

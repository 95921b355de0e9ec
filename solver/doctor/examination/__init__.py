"""What is wrong with a whole recording, and its repair."""

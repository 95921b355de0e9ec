"""What a person's joints can do, and how far a motion goes beyond it."""

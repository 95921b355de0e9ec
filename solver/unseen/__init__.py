"""What carries the body though the recording does not show it."""

"""What comes once a result's keys are written: marks, fewer keys, and what is told of it."""

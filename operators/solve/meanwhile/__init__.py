"""What others do to the scene between two parts of a task."""

"""What is minimised: the distance to a recording, and the objectives of the explicit solution."""

"""User actions; the only place that words errors to the user."""

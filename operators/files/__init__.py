"""Files of results: together or not at all, and by one run at a time."""

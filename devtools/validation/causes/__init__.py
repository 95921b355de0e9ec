"""What explains the figures: constants changed, and landings as they were recorded."""

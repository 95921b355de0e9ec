"""What is wrong with a recording: examine, repair, trim."""

"""Without a window: the command line, its job, stages and output files."""

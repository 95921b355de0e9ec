"""The queue of a run: which cells wait, run and have ended."""

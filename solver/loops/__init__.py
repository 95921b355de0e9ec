"""Loops: which frames of a take are one cycle, and how well its end meets its start."""

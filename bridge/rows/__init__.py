"""Rows of the stored lists: their bones, when they hold, and what a kind of constraint declares."""

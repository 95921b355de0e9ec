"""Faults, outcomes, analyses and reports in the artist's words."""

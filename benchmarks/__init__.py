"""Comparisons that are not part of the extension."""

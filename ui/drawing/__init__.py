"""Flat drawings as data, and their painting in a region."""

"""Operators of the lists: contacts, constraints, body changes, presets."""

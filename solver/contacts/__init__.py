"""Contacts of a recording with the ground: when they begin and end, and where."""

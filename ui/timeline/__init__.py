"""Contacts and phases as bars in the timeline and the dope sheet."""

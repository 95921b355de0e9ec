"""Contacts and phases as bars in the timeline, and dragging their ends."""

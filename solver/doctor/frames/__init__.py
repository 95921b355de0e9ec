"""Frames that do not belong to those around them."""

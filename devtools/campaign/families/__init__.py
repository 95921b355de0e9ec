"""Families of hostile cases."""

"""Validation: contact forces of the fit against force plates (python3 dev.py validate)."""

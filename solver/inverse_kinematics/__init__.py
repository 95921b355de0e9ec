"""Poses that reach: gripping arms, and roots under which contacts stay where they are."""

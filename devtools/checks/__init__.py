"""Tests, lint, types, and the physics checked by other engines."""

"""Bones outside of the body that go along with it: a root bone, and what keeps its place on it."""

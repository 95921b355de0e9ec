"""Whole takes: a result within the take it comes from, and the takes of an armature."""

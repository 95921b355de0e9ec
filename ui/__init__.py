"""Panels, lists and property groups; draw() reads cached text and computes nothing."""

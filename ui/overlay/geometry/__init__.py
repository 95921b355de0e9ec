"""Shapes of the overlay as arrays, and their colours: numpy only."""

"""What the artist sees: panels, overlays, gizmos, plots, bars; and their registration."""

"""The artist's surface: panels, overlays, gizmos, plots, bars; and their registration."""

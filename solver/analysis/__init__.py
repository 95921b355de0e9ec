"""Analysis of a recording: joint angles, contact detection, and the places of pinned contacts."""

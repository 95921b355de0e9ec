"""From a recording to a performance: joint angles, contact detection, soles, pinned places."""

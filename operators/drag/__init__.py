"""Modal drags in the 3D viewport: pins, limits, cones, stances."""

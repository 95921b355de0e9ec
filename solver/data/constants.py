"""Physical constants and directions of the world frame (Z up)."""

import numpy as np

STANDARD_GRAVITY = 9.81  # m/s²; the unit of "body weights" also where a problem's gravity differs
DEFAULT_FRICTION = 1.0  # of a rubber sole on a hall's floor
UP = np.array([0.0, 0.0, 1.0])
UP.flags.writeable = False
STATURES = 0.3, 3.0  # m; nobody who jumps is less tall, or taller

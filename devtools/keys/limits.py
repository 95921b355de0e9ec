"""What reduced keys must reach."""

from ..figures.limits import Figure, Limit

RATE = "keys a second and channel"
LIMITS = {
    RATE: Limit("1/s", 12.0, 6.0),
    "joint centres off, every frame": Limit("mm", 2.0),
    "bones turned, every frame": Limit("degrees", 0.2),
    "pinned point's drift": Limit("mm", 2.0, 0.5),
    "time": Limit("s"),
}
# Musts that are not reached yet, each with the value that it must not pass meanwhile. Even bones
# that are reduced alone need some 10 keys a second for 0.2 degrees.
KNOWN_MISSES = {RATE: 15.0}
ROUNDING = 1.001  # F-curves are single precision


def missed(figures: list[Figure]) -> list[Figure]:
    """Figures beyond their musts that are not known to be."""
    return [
        f
        for f in figures
        if f.must is not None and f.value > max(f.must * ROUNDING, KNOWN_MISSES.get(f.name, f.must))
    ]

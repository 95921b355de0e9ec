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
ROUNDING = 1.001  # F-curves are single precision


def missed(figures: list[Figure]) -> list[Figure]:
    """Figures beyond their musts."""
    return [f for f in figures if f.must is not None and f.value > f.must * ROUNDING]

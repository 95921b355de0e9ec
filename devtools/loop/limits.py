"""What loops must reach."""

from ..figures.limits import Limit

LIMITS = {
    "solved": Limit("1 = yes", 1.0, 1.0, at_least=True),
    "seam, as Blender plays it: pose": Limit("mm", 0.5, 0.0),
    "seam, as Blender plays it: velocity": Limit("mm/s", 5.0, 0.0),
    "seam, as solved: velocity": Limit("mm/s", 5.0, 0.0),
    "seam, as solved: force of a point": Limit("BW", 0.02, 0.0),
    "seam: force that the played motion needs, against the solved": Limit("BW", 0.02),
    "second cycle against the first": Limit("mm", 0.5, 0.0),
    "flight: root force not explained, rms": Limit("BW", 0.003, 0.0005),
    "flight: root moment not explained, rms": Limit("BW·m", 0.001, 0.0003),
    "ground: root force not explained, rms": Limit("BW", 0.02, 0.005),
    "ground: root moment not explained, rms": Limit("BW·m", 0.02, 0.005),
    "beside the seam: root force not explained, max": Limit("BW", 0.02),
    "beside the seam: root moment not explained, max": Limit("BW·m", 0.02),
    "joint centres off the recording, rms": Limit("cm"),
    "frames by which the artist's end moves": Limit("1"),
}

"""How strong human joints are: the largest voluntary torques of the legs.

Isometric maxima of men of 18 to 25 years, by Anderson, Madigan and Nussbaum (Maximum voluntary
joint torque as a function of joint angle and angular velocity, Journal of Biomechanics 40, 2007,
table 3, C1), as shares of body weight times height; the stronger direction of each joint. Muscles
that are stretched while they work, as in a landing, hold more; those that shorten quickly, less.
"""

from collections.abc import Mapping

from .anatomy import Part

GRAVITY = 9.81  # m/s², where strength was measured
# By the part below the joint: hip extension, knee extension, plantar flexion.
SHARES: Mapping[Part, float] = {Part.THIGH: 0.161, Part.SHANK: 0.163, Part.FOOT: 0.095}
JOINTS: Mapping[Part, str] = {Part.THIGH: "Hip", Part.SHANK: "Knee", Part.FOOT: "Ankle"}


def strongest(part: Part, mass: float, height: float) -> float:
    """Largest torque, N·m, of the joint above a part. mass: kg, height: m, the body's."""
    return SHARES[part] * mass * GRAVITY * height

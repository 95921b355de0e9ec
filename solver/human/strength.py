"""Human joint strength: peak voluntary torques of the legs.

Isometric maxima of men of 18 to 25 years, by Anderson, Madigan and Nussbaum (Maximum voluntary
joint torque as a function of joint angle and angular velocity, Journal of Biomechanics 40, 2007,
table 3, C1), as shares of body weight times height; the stronger direction of each joint. Muscles
that are stretched while they work, as in a landing, hold more (after Katz, The relation
between force and speed in muscular contraction, Journal of Physiology 96, 1939); those that shorten
quickly, less. Half as much again is what models of muscles usually allow; whole limbs of people
often show less (review: Alcazar et al., Frontiers in Physiology 10, 2019).
"""

from collections.abc import Mapping

from ..body.anatomy import Part
from ..data.constants import STANDARD_GRAVITY

# By the part below the joint: hip extension, knee extension, plantar flexion.
PEAK_TORQUE_SHARES: Mapping[Part, float] = {Part.THIGH: 0.161, Part.SHANK: 0.163, Part.FOOT: 0.095}
ECCENTRIC_FACTOR = 1.5
LEG_JOINTS: Mapping[Part, str] = {Part.THIGH: "Hip", Part.SHANK: "Knee", Part.FOOT: "Ankle"}


def peak_torque(part: Part, mass: float, height: float) -> float:
    """Peak torque, N·m, of the joint above a part: share x body weight x height.

    mass: kg, height: m, the body's. Raises KeyError for a part without a value.
    """
    return PEAK_TORQUE_SHARES[part] * mass * STANDARD_GRAVITY * height

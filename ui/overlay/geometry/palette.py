"""The overlays' colours, as in the pictures (bridge/picture) but for dark viewports."""

from ...drawing.sketch import Colour

PIN: Colour = (0.90, 0.13, 0.16, 1.0)
PIN_OFF: Colour = (0.62, 0.62, 0.62, 0.30)
MOVE: Colour = (1.00, 0.45, 0.40, 0.9)  # from where a pin was found to where it shall be
LIMIT: Colour = (0.95, 0.22, 0.26, 1.0)
WITHIN: Colour = (1.0, 1.0, 1.0, 0.95)  # how a limb is bent now, within its limits
BEYOND: Colour = (1.0, 0.78, 0.15, 1.0)
UNCHANGED: Colour = (0.45, 0.60, 0.85, 1.0)  # of a joint that is as it was recorded
POSE: Colour = (1.0, 1.0, 1.0, 0.55)
ADAPTED: Colour = (0.40, 0.72, 1.0, 1.0)
RECORDED: Colour = (0.80, 0.80, 0.80, 1.0)
LIVE: Colour = (0.25, 0.95, 0.85, 1.0)
PARABOLA: Colour = (1.0, 0.68, 0.20, 1.0)
FORCE: Colour = (0.35, 0.85, 0.38, 1.0)
UNSEEN: Colour = (1.0, 0.45, 0.85, 1.0)  # the force of what the recording does not show
FAULT: Colour = (1.0, 0.55, 0.0, 1.0)  # what is wrong with a recording
SOLID_SHAPE: Colour = (0.85, 0.85, 0.85, 0.6)
OVERLAP: Colour = (1.00, 0.10, 0.10, 1.0)
MOMENTUM: Colour = (0.74, 0.52, 1.0, 1.0)

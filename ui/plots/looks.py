"""Colours and sizes of the plots; sizes in px at an interface scale of 1."""

from ...bridge.plots.curves import Take
from ...solver.data.contacts import PhaseKind
from ..drawing.sketch import Colour

CARD: Colour = (0.07, 0.07, 0.08, 0.8)
TITLE: Colour = (0.95, 0.95, 0.95, 1.0)
WORDS: Colour = (0.78, 0.78, 0.8, 1.0)
FAINT: Colour = (0.62, 0.62, 0.66, 1.0)
GRID: Colour = (1.0, 1.0, 1.0, 0.1)
CAP: Colour = (1.0, 0.32, 0.3, 1.0)
PLAYHEAD: Colour = (0.35, 0.6, 1.0, 1.0)
PLATE: Colour = (0.2, 0.42, 0.78, 1.0)
BANDS: dict[PhaseKind, Colour] = {
    PhaseKind.GROUND: (0.75, 0.68, 0.55, 0.07),
    PhaseKind.FLIGHT: (0.4, 0.62, 1.0, 0.1),
}
TAKES: dict[Take, Colour] = {
    Take.RECORDING: (0.8, 0.82, 0.86, 1.0),
    Take.ADAPTED: (1.0, 0.65, 0.2, 1.0),
}
PART: Colour = (0.95, 0.95, 0.4, 0.9)  # of a curve that shows only a part

FONT, SMALL = 11.0, 9.5
LINE = 16.0  # from base line to base line
PADDING = 6.0
FOOT = 16.0  # for the frames' numbers
LABEL_GAP = 4.0  # between a number and its axis
STROKE = 1.4
DASH = 5.0
FRAMES_APART, VALUES_APART = 46.0, 22.0
PLATE_WIDTH = 34.0
TICK_WIDTH = 22.0  # about, of a frame's number
SWATCH = 10.0

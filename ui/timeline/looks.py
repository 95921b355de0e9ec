"""Colours and sizes of the bars; sizes in px at an interface scale of 1."""

from ..drawing.sketch import Colour

BACK: Colour = (0.05, 0.05, 0.06, 0.55)
LEFT: Colour = (0.3, 0.55, 0.95, 0.75)
RIGHT: Colour = (0.95, 0.5, 0.3, 0.75)
OTHER: Colour = (0.5, 0.75, 0.4, 0.75)
GROUND: Colour = (0.55, 0.5, 0.42, 0.85)
FLIGHT: Colour = (0.3, 0.42, 0.7, 0.45)
EDGE: Colour = (1.0, 1.0, 1.0, 0.85)
CHOSEN: Colour = (1.0, 1.0, 1.0, 1.0)
UNUSED: Colour = (0.7, 0.7, 0.7, 0.55)
WORDS: Colour = (1.0, 1.0, 1.0, 1.0)
FAINT: Colour = (0.75, 0.75, 0.78, 0.9)

INSET = 1.0  # between rows
FONT = 10.0
READABLE = 12.0  # a row that is lower holds no words
PADDING = 5.0
GRIP = 2.0  # width of an edge
HATCH = 7.0  # between the strokes over what does not count
STROKE = 1.0

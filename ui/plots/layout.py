"""Layout of plots in a viewport: the room that bars and the sidebar leave, and the cards in it."""

from collections.abc import Iterable

from ...bridge.plots.screen import Rect

# px at an interface scale of 1
MARGIN = 8.0
GAP = 6.0
NARROWEST, WIDEST = 190.0, 460.0
LOWEST, HIGHEST = 92.0, 150.0
SHARE = 0.4  # of the viewport's height that plots may take


def free_room(width: float, height: float, overlaps: Iterable[tuple[str, Rect]]) -> Rect:
    """The rectangle that overlapping regions leave of a viewport; theirs are in its px.

    overlaps: for each region the side that it sticks to ("LEFT", ...), and where it is.
    """
    left, bottom, right, top = 0.0, 0.0, width, height
    for side, rect in overlaps:
        if rect.right <= 0.0 or rect.left >= width or rect.top <= 0.0 or rect.bottom >= height:
            continue  # beside the viewport, not upon it
        if side == "LEFT":
            left = max(left, rect.right)
        elif side == "RIGHT":
            right = min(right, rect.left)
        elif side == "BOTTOM":
            bottom = max(bottom, rect.top)
        elif side == "TOP":
            top = min(top, rect.bottom)
    return Rect(left, bottom, max(left, right), max(bottom, top))


def cards(free: Rect, count: int, scale: float) -> tuple[Rect, ...]:
    """Rectangles for `count` charts at the foot of the free room, from left to right, top down.

    Fewer, or none, where there is no room; the first are the ones that remain.
    """
    margin, gap = MARGIN * scale, GAP * scale
    wide, high = free.width - 2.0 * margin, SHARE * free.height - margin
    columns = min(count, int((wide + gap) // (NARROWEST * scale + gap)))
    most = int((high + gap) // (LOWEST * scale + gap))
    if columns < 1 or most < 1:
        return ()
    rows = min(-(-count // columns), most)
    columns = min(columns, -(-count // rows))  # two and two rather than three and one
    width = min((wide + gap) / columns - gap, WIDEST * scale)
    height = min((high + gap) / rows - gap, HIGHEST * scale)
    places = []
    for index in range(min(count, columns * rows)):
        row, column = divmod(index, columns)
        left = free.left + margin + column * (width + gap)
        bottom = free.bottom + margin + (rows - 1 - row) * (height + gap)
        places.append(Rect(left, bottom, left + width, bottom + height))
    return tuple(places)

"""Result options of a recipe: what becomes of the rest of the take. Keys: see problem.py."""

from dataclasses import dataclass

from ...solver.data.faults import ReturnTooEarly, ReturnTooLate
from ..recipe_syntax.items import Kind, choice, flag, number
from ..recipe_syntax.table import NOT_NEGATIVE
from ..rows.choices import After, ContactMarkers, WrittenAs


@dataclass(frozen=True)
class ResultOptions:
    """What a result holds beside the adapted frames.

    return_frame: of the recording, by which it is back; None is a second after the adapted frames.
    blend_in, blend_out: frames before and after the adapted ones; None is a quarter of a second.
    markers, contact_channels: how contacts are told (keys/contact_marks.py).
    lock_others: channels that physics does not own keep their times where durations changed.
    """

    after: After = After.CARRY
    return_frame: float | None = None
    blend_in: float | None = None
    blend_out: float | None = None
    lock_others: bool = False
    written_as: WrittenAs = WrittenAs.ACTION
    markers: ContactMarkers = ContactMarkers.NONE
    contact_channels: bool = False

    @property
    def others_stay(self) -> bool:
        """Whether channels that physics does not own keep their times: a difference has none."""
        return self.lock_others or self.written_as is WrittenAs.COMBINE


def require_return_after(options: ResultOptions, last: float) -> None:
    """Raises ReturnTooEarly where the take is to be back before it was away. last: frame of the
    recording, the last that is adapted."""
    frame = options.return_frame
    if options.after is After.RETURN and frame is not None and frame <= last:
        raise ReturnTooEarly(frame, last)


def require_return_within(options: ResultOptions, end: float) -> None:
    """Raises ReturnTooLate where the take is to be back by a frame that it does not have: all of
    the way back would be squeezed into what is left. end: the take's last."""
    frame = options.return_frame
    if options.after is After.RETURN and frame is not None and frame > end:
        raise ReturnTooLate(frame, end)


RESULT = Kind(
    "result",
    ResultOptions,
    (
        choice("after", After),
        number("return_frame"),
        number("blend_in", NOT_NEGATIVE),
        number("blend_out", NOT_NEGATIVE),
        flag("lock_others"),
        choice("written_as", WrittenAs),
        choice("markers", ContactMarkers),
        flag("contact_channels"),
    ),
    named=False,
)

"""Records of contacts in recipes: pins, corrections of what the analysis found, and additions."""

from collections.abc import Iterable
from dataclasses import asdict

from ...solver.data.problem import AddedContact, ContactEdit, OffsetAxes, Pin
from ..recipe_syntax.items import (
    TOUCHING,
    TRAVEL_KEYS,
    TRAVEL_WORDS,
    Item,
    Kind,
    Values,
    angle,
    one,
    phase,
    travelled,
    vector,
    word,
)
from ..recipe_syntax.table import NumberRange, Table
from ..recipe_syntax.toml_text import entries

SPAN = ("start_frame", "end_frame")
# More than one is asked about; a clip has no time for more than ten.
TEN_TURNS = NumberRange("from -3600 to 3600 degrees", lambda value: abs(value) <= 3600.0)


def _read_offset(table: Table) -> Values:
    table.not_both("offset", TRAVEL_WORDS)
    offset = table.vector("offset")
    if offset is not None:
        return {"offset": offset, "axes": OffsetAxes.WORLD}
    return {"offset": travelled(table)}


def _write_offset(pin: Pin) -> Values:
    if pin.axes is OffsetAxes.WORLD:
        return {"offset": pin.offset}
    return {key: amount or None for key, amount in zip(TRAVEL_KEYS, pin.offset, strict=True)}


def _read_span(table: Table) -> Values:
    start, end = map(table.number, SPAN)
    if start is not None and end is not None and start >= end:
        table.refuse("end_frame", f"the end, {end:g}, must come after the start, {start:g}")
    return {"start_frame": start, "end_frame": end}


def _write_span(contact: AddedContact) -> Values:
    return {"start_frame": contact.start_frame, "end_frame": contact.end_frame}


def point_name(word: str) -> str:
    """A point's name ("Left toe"), whatever the capitals."""
    return " ".join(word.split()).capitalize()


def _point(table: Table, key: str) -> str:
    return point_name(table.word(key) or "")


def _read_correction(table: Table) -> Values:
    table.not_both("remove", SPAN)
    return {**_read_span(table), "remove": table.flag("remove")}


def _write_correction(edit: ContactEdit) -> Values:
    if edit.remove:
        return {"remove": True}
    return {"start_frame": edit.start_frame, "end_frame": edit.end_frame}


PIN = Kind(
    "pin",
    Pin,
    (
        phase("phase"),
        TOUCHING,
        word("step"),
        Item((*TRAVEL_WORDS, "offset"), _read_offset, _write_offset),
        vector("place"),
        angle("turn", TEN_TURNS),
        word("on"),
    ),
    needs=(("phase",),),
    excludes=(("step", "points", "bones"),),
)
CONTACT = Kind(
    "contact",
    ContactEdit,
    (
        word("name"),
        Item((*SPAN, "remove"), _read_correction, _write_correction),
    ),
    needs=(("name",),),
    named=False,
)

ADDED = Kind(
    "add_contact",
    AddedContact,
    (one("point", _point), Item(SPAN, _read_span, _write_span)),
    needs=(("point",), ("start_frame",), ("end_frame",)),
    named=False,
)


def added_texts(contacts: Iterable[AddedContact]) -> list[str]:
    """The tables of contacts to add."""
    return [f"[[{ADDED.header}]]\n{entries(asdict(each))}" for each in contacts]

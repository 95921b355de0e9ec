"""Wording of a failure for the sidebar: a short line, the whole, and what is furthest off."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from textwrap import shorten

from ...solver.data.faults import Fault, NoFit, NoSolution
from ...solver.data.row_kinds import RowKind
from .messages import Translate, is_in_its_way, missed, sentence

NO_MOTION = "No motion: {}"
NO_FIT = "The recording itself cannot be held: {}"
REACHED = "The best found goes {} % of the way."
MOST_ROWS = 4
LAWS = (RowKind.BALANCE, RowKind.MOMENT)  # told last: only what was asked for can be asked less of
MOST_LETTERS = 100  # of the short line
BEFORE_CURE = re.compile(r"; (?![^()]*\))")  # not in brackets


@dataclass(frozen=True)
class FailureRow:
    """Something that is missed: the name by which the lists have it, and what is left."""

    name: str
    text: str


@dataclass(frozen=True)
class Failure:
    """Why the last solve of an armature (its number in this session) failed.

    short: one line for the status bar. text: the whole of it, or what it says beside that line and
    the rows where there are rows: what was asked for, the worst first, before laws of motion. of:
    the operator that failed. fault: what happened. cure_first: one line that may be cut off at its
    end: what to do, and after it what is wrong.
    """

    uid: int
    of: str
    fault: Fault
    short: str
    text: str
    cure_first: str
    rows: tuple[FailureRow, ...] = ()

    @property
    def head(self) -> str:
        """The short line without what the rows say."""
        return self.short.partition(":")[0] if self.rows else self.short


def failure_of(fault: Fault, uid: int, of: str, translate: Translate = str) -> Failure:
    """A fault in the sidebar's words."""
    told = sentence(fault, translate)
    if not isinstance(fault, NoSolution) or not fault.worst:
        wrong, cure = _parted(told)
        short = shorten(wrong, MOST_LETTERS, placeholder=" …")
        return Failure(uid, of, fault, short, told, f"{cure} {wrong}." if cure else short)
    worst = sorted(fault.worst, key=lambda each: each.kind in LAWS)[:MOST_ROWS]
    rows = tuple(FailureRow(each.name, _begun_large(missed(each, translate))) for each in worst)
    first = missed(worst[0], translate)
    head = translate(NO_FIT if isinstance(fault, NoFit) else NO_MOTION).format(first)
    advice = told if is_in_its_way(fault) else sentence(replace(fault, worst=()), translate)
    if fault.goes_part:
        advice = f"{advice} {translate(REACHED).format(round(100.0 * fault.reached))}"
    return Failure(uid, of, fault, head, advice, head, rows)


def _parted(told: str) -> tuple[str, str]:
    """What is wrong, without its full stop, and what to do about it; "" where that is not told."""
    *wrong, cure = BEFORE_CURE.split(told)
    return ("; ".join(wrong), _begun_large(cure)) if wrong else (told.rstrip("."), "")


def _begun_large(text: str) -> str:
    return text[:1].upper() + text[1:]

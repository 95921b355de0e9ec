"""Profiler of interface latency: how long Blender is blocked, and by which function of ours.

A timer that Blender calls whenever it is free tells how long it was not. Where a processor draws
the window, most of that is waiting for the picture; so the time that the thread itself computed is
kept beside it, which is what a graphics card would leave. Python's own monitoring tells how long
Blender was in the extension's code at a profile: operators, panels, handlers, timers.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from inspect import CO_GENERATOR
from threading import get_ident
from types import CodeType

import bpy

TOOL = 3  # one of the numbers that Python leaves free for tools
MONITORING = vars(sys)["monitoring"]  # Python 3.12, which Debian's Blender has


@dataclass(frozen=True)
class ClockReading:
    """Wall-clock time, and CPU time of Blender's main thread (s)."""

    clock: float
    busy: float

    @staticmethod
    def now() -> ClockReading:
        return ClockReading(time.perf_counter(), time.thread_time())


NEVER = ClockReading(0.0, 0.0)


@dataclass
class Durations:
    """Count, maximum and sum of durations (s), by the clock; busy: of CPU time."""

    count: int = 0
    longest: float = 0.0
    total: float = 0.0
    busy_longest: float = 0.0
    busy_total: float = 0.0

    def add(self, since: ClockReading, until: ClockReading) -> None:
        seconds, busy = until.clock - since.clock, until.busy - since.busy
        self.count += 1
        self.longest = max(self.longest, seconds)
        self.total += seconds
        self.busy_longest = max(self.busy_longest, busy)
        self.busy_total += busy


@dataclass
class Profile:
    """Durations measured under one label. gaps: between Blender's free moments; calls: of the
    package's functions by Blender, by their names."""

    gaps: Durations = field(default_factory=Durations)
    calls: dict[str, Durations] = field(default_factory=dict)


@dataclass
class Profiler:
    """Measures between `start` and `stop`. folder: part of the path of the package's
    files; label: says what goes on; asked at each free moment."""

    folder: str
    profiles: dict[str, Profile] = field(default_factory=dict)
    _label: Callable[[], str] | None = None
    _now: str = ""  # the label as it was at the last free moment
    _free_since: ClockReading = NEVER
    _running: bool = False  # the timer is on
    _depth: int = 0
    _entered: ClockReading = NEVER
    _fresh: set[str] = field(default_factory=set)
    _thread: int = field(default_factory=get_ident)

    def start(self, label: Callable[[], str]) -> None:
        """Measure from now on; earlier profiles of the same labels are dropped."""
        self._watch()
        self._depth, self._label, self._now = 0, label, label()
        self._fresh.clear()
        self._free_since = ClockReading.now()
        if not self._running:
            self._running = True
            bpy.app.timers.register(self._free, first_interval=0.0, persistent=True)

    def stop(self) -> None:
        """Measure no more; the numbers stay."""
        self._label = None

    def _profile(self) -> Profile:
        if self._now not in self._fresh:
            self._fresh.add(self._now)
            self.profiles[self._now] = Profile()
        return self.profiles[self._now]

    def _free(self) -> float | None:
        if self._label is None:
            self._running = False
            return None
        self._profile().gaps.add(self._free_since, ClockReading.now())
        self._free_since = ClockReading.now()
        self._now = self._label()
        return 0.0

    def _watch(self) -> None:
        """Trace calls of the package's functions (sys.monitoring)."""
        events = MONITORING.events
        if MONITORING.get_tool(TOOL) is None:
            MONITORING.use_tool_id(TOOL, "window")
            MONITORING.register_callback(TOOL, events.PY_START, self._enter)
            MONITORING.register_callback(TOOL, events.PY_RETURN, self._leave)
            MONITORING.register_callback(TOOL, events.PY_UNWIND, self._unwind)
            MONITORING.set_events(TOOL, events.PY_START | events.PY_RETURN | events.PY_UNWIND)

    def _foreign(self, code: CodeType) -> bool:
        """True for functions that are not the package's, and for generators."""
        return self.folder not in code.co_filename or bool(code.co_flags & CO_GENERATOR)

    def _enter(self, code: CodeType, _offset: int) -> object:
        if self._foreign(code):
            return MONITORING.DISABLE  # be not asked again for this code
        if get_ident() != self._thread:
            return None
        if self._depth == 0:
            self._entered = ClockReading.now()
        self._depth += 1
        return None

    def _leave(self, code: CodeType, _offset: int, _result: object) -> object:
        if self._foreign(code):
            return MONITORING.DISABLE
        if get_ident() != self._thread or self._depth == 0:
            return None
        self._depth -= 1
        if self._depth == 0 and self._label is not None:
            spans = self._profile().calls.setdefault(code.co_qualname, Durations())
            spans.add(self._entered, ClockReading.now())
        return None

    def _unwind(self, code: CodeType, offset: int, fault: BaseException) -> None:
        self._leave(code, offset, fault)  # of an exception Python always tells

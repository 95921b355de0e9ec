"""Profiler of interface latency: how long Blender is blocked, and by which function of ours.

A timer that Blender calls whenever it is free tells how long it was not. Where a processor draws
the window, most of that is waiting for the picture; so the time that the thread itself computed is
kept beside it, which is what a graphics card would leave. Python's own monitoring tells how long
Blender was in the extension's code at a profile: operators, panels, handlers, timers.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from threading import get_ident
from types import CodeType, FunctionType, ModuleType

import bpy

TOOL = 3  # one of the numbers that Python leaves free for tools
GENERATOR = 0x20  # of a code's flags: its calls are told by other events, and are never Blender's


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
    """Measures between `start` and `stop`. label: says what goes on; asked at each free moment."""

    package: str
    profiles: dict[str, Profile] = field(default_factory=dict)
    _label: Callable[[], str] | None = None
    _now: str = ""  # the label as it was at the last free moment
    _free_since: ClockReading = NEVER
    _running: bool = False  # the timer is on
    _codes: set[CodeType] = field(default_factory=set)
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
        """Trace calls of the package's functions that are loaded by now (sys.monitoring)."""
        monitoring = vars(sys)["monitoring"]  # Python 3.12, which Debian's Blender has
        events = monitoring.events
        if monitoring.get_tool(TOOL) is None:
            monitoring.use_tool_id(TOOL, "window")
            monitoring.register_callback(TOOL, events.PY_START, self._enter)
            monitoring.register_callback(TOOL, events.PY_RETURN, self._leave)
            monitoring.register_callback(TOOL, events.PY_UNWIND, self._leave)
            monitoring.set_events(TOOL, events.PY_UNWIND)  # Python offers it for all code only
        for code in set(codes(self.package)) - self._codes:
            monitoring.set_local_events(TOOL, code, events.PY_START | events.PY_RETURN)
            self._codes.add(code)

    def _enter(self, _code: CodeType, _offset: int) -> None:
        if get_ident() != self._thread:
            return
        if self._depth == 0:
            self._entered = ClockReading.now()
        self._depth += 1

    def _leave(self, code: CodeType, _offset: int, _result: object) -> None:
        if code not in self._codes or get_ident() != self._thread or self._depth == 0:
            return
        self._depth -= 1
        if self._depth == 0 and self._label is not None:
            spans = self._profile().calls.setdefault(code.co_qualname, Durations())
            spans.add(self._entered, ClockReading.now())


def codes(package: str) -> Iterator[CodeType]:
    """The code of every function of the package's loaded modules, inner functions included."""
    for name, module in list(sys.modules.items()):
        if name == package or name.startswith(f"{package}."):
            for function in functions(module):
                yield from nested(function.__code__)


def functions(owner: ModuleType | type) -> Iterator[FunctionType]:
    """The functions that a module or class defines itself, its classes' included."""
    name = owner.__name__ if isinstance(owner, ModuleType) else owner.__module__
    for member in list(vars(owner).values()):
        plain = getattr(member, "__func__", None) or getattr(member, "__wrapped__", member)
        for each in (plain, getattr(member, "fget", None)):
            if isinstance(each, FunctionType) and each.__module__ == name:
                yield each
            elif isinstance(each, type) and each.__module__ == name and each is not owner:
                yield from functions(each)


def nested(code: CodeType) -> Iterator[CodeType]:
    """A code and those of the functions made in it; generators left out."""
    if not code.co_flags & GENERATOR:
        yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from nested(constant)

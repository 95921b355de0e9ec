"""Mouse and keyboard input for a program under X, by one xdotool that is fed line after line.

The moves run in that process at their own pace, so that whoever gives them is not held up.
Standard library only. Places are pixels of the screen from its upper left corner.
"""

from __future__ import annotations

import math
import os
import subprocess
import time
from dataclasses import dataclass, field

Place = tuple[float, float]
STEP = 1 / 60  # s between the places of a smooth move
SPEED = 2400.0  # pixels per second
LONGEST = 0.4  # s a move takes at most
KEY_PAUSE = 0.02  # s between keys
KEYCODES = {"F3": "69"}  # by its name newer keyboard maps of X have xdotool hold Alt beside it
SAY_DONE = "getmouselocation"  # any line that prints one
PRESS = 0.06  # s that a button is held in a click


@dataclass(frozen=True)
class Click:
    """A press of a mouse's button: when (s, monotonic), where, on what and in which task."""

    at: float
    place: Place
    on: str
    task: str


@dataclass
class InputDevice:
    """A mouse and a keyboard. Each action is told at once and says how many seconds it will take at
    least; it is done when `busy` is false.

    task: what the clicks are for, kept with each.
    """

    task: str = ""
    clicks: list[Click] = field(default_factory=list)
    place: Place = (0.0, 0.0)
    _free_at: float = 0.0  # when the last action will have been done
    _told: int = 0  # actions
    _done: int = 0

    def __post_init__(self) -> None:
        self._xdotool = subprocess.Popen(
            ["xdotool", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        assert self._xdotool.stdin is not None
        assert self._xdotool.stdout is not None
        self._input, self._output = self._xdotool.stdin, self._xdotool.stdout
        os.set_blocking(self._output.fileno(), False)

    @property
    def busy(self) -> bool:
        """Whether actions are still pending."""
        self._done += (self._output.read() or b"").count(b"\n")
        return self._done < self._told

    def close(self) -> None:
        """Drop the mouse and the keyboard."""
        self._input.close()
        self._xdotool.terminate()
        self._xdotool.wait(timeout=5)

    def move(self, to: Place, seconds: float | None = None) -> float:
        """Move there by a straight and smooth path."""
        return self._act(smooth_path(self.place, to, seconds), to)

    def click(self, to: Place, on: str) -> float:
        """Move there and click; `on` says what lies there."""
        self.clicks.append(Click(time.monotonic(), to, on, self.task))
        press = ["sleep 0.05", "mousedown 1", f"sleep {PRESS}", "mouseup 1", "sleep 0.02"]
        return self._act([*smooth_path(self.place, to), *press], to)

    def forget(self, on: str) -> None:
        """Drop the last clicks from the record, as far as they were on this."""
        while self.clicks and self.clicks[-1].on == on:
            self.clicks.pop()

    def press(self, to: Place, on: str) -> float:
        """Move there and press the left button."""
        self.clicks.append(Click(time.monotonic(), to, on, self.task))
        press = ["sleep 0.1", "mousedown 1", "sleep 0.05"]
        return self._act([*smooth_path(self.place, to), *press], to)

    def let_go(self) -> float:
        """Let go of the left button."""
        return self._act(["sleep 0.05", "mouseup 1"], self.place)

    def wheel(self, to: Place, notches: int) -> float:
        """Turn the wheel there, downwards where positive."""
        button = 5 if notches > 0 else 4
        turn = [f"click {button}", "sleep 0.02"] * abs(notches)
        return self._act([*smooth_path(self.place, to), *turn], to)

    def key(self, *names: str) -> float:
        """Press keys one after another, each by its X name, such as `ctrl+z`."""
        keys = [KEYCODES.get(name, name) for name in names]
        lines = [line for key in keys for line in (f"key {key}", f"sleep {KEY_PAUSE}")]
        return self._act(lines, self.place)

    def type(self, text: str) -> float:
        """Type plain text."""
        lines = [f"type --delay 15 {quoted(text)}", f"sleep {0.015 * len(text):.3f}"]
        return self._act(lines, self.place) + 0.015 * len(text)

    def _act(self, lines: list[str], to: Place) -> float:
        """Send the lines; the seconds until all that was sent will have been done."""
        self._input.write("\n".join([*lines, SAY_DONE, ""]).encode())
        self._input.flush()
        self._told += 1
        self.place = to
        now = time.monotonic()
        self._free_at = max(self._free_at, now) + sum(map(duration, lines))
        return self._free_at - now


def smooth_path(start: Place, end: Place, seconds: float | None = None) -> list[str]:
    """Lines that move the pointer from one place to another, slowly at both ends; in no time where
    that is asked for."""
    if seconds == 0.0:
        return [f"mousemove {round(end[0])} {round(end[1])}"]
    far = math.dist(start, end)
    seconds = min(far / SPEED, LONGEST) if seconds is None else seconds
    steps = max(1, round(seconds / STEP))
    lines = []
    for i in range(1, steps + 1):
        part = (1 - math.cos(math.pi * i / steps)) / 2
        x, y = (a + part * (b - a) for a, b in zip(start, end, strict=True))
        lines += [f"mousemove {round(x)} {round(y)}", f"sleep {STEP:.4f}"]
    return lines


def duration(line: str) -> float:
    """Seconds that a line of xdotool takes."""
    word, _, rest = line.partition(" ")
    return float(rest) if word == "sleep" else 0.001


def quoted(text: str) -> str:
    """The text as one word of an xdotool line. Raises ValueError for what has no such form."""
    if '"' in text or "\n" in text:
        raise ValueError(f"xdotool cannot be given {text!r} in a line")
    return f'"{text}"'

"""Plays scenes in a Blender with a window, one after another, and keeps what became of them.

A scene is a generator that acts and yields what to wait for: seconds, or a condition with a limit.
It ends well or by an exception, which becomes the scene's failure beside a picture of the screen.
"""

from __future__ import annotations

import json
import subprocess
import time
import traceback
from collections.abc import Callable, Generator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TypeVar

import bpy

from .eyes import Eyes
from .gauge import Gauge
from .hands import Hands

TICK = 0.01  # s between looks at a condition
LONGEST_ACTION = 20.0  # s that the hands may take for what they were told


@dataclass(frozen=True)
class Until:
    """Wait for `holds`; after `limit` seconds the scene fails with `what` did not come."""

    what: str
    holds: Callable[[], object]
    limit: float = 10.0


Acting = Generator["float | Until", None, None]
Steps = Generator[float, None, None]
Result = TypeVar("Result")


@dataclass
class Outcome:
    """What became of a scene. failure: None where it went well, the sentence where not."""

    name: str
    seconds: float = 0.0
    failure: str | None = "it did not come to its end: Blender ended or hung"
    where: str = ""  # the failure's traceback
    skipped: bool = False
    pictures: list[str] = field(default_factory=list)


@dataclass
class Stage:
    """All that a scene has in its hands. Results are written to `out` after every scene."""

    out: Path
    hands: Hands
    eyes: Eyes
    gauge: Gauge
    figures: dict[str, float] = field(default_factory=dict)
    outcomes: list[Outcome] = field(default_factory=list)

    def picture(self, name: str) -> Acting:
        """Keep the screen as NN_name.png, without holding up Blender meanwhile."""
        count = sum(len(outcome.pictures) for outcome in self.outcomes) + 1
        file = f"{count:02d}_{name}.png"
        taking = subprocess.Popen(["import", "-window", "root", str(self.out / file)])
        yield Until("the picture of the screen", lambda: taking.poll() is not None)
        self.outcomes[-1].pictures.append(file)

    def keep(self) -> None:
        """Write what is known so far."""
        known = {
            "scenes": [asdict(outcome) for outcome in self.outcomes],
            "figures": self.figures,
            "stretches": {name: asdict(s) for name, s in self.gauge.stretches.items()},
            "clicks": [asdict(click) for click in self.hands.clicks],
        }
        (self.out / "play.json").write_text(json.dumps(known, indent=1))


@dataclass(frozen=True)
class Scene:
    """A named part of the play. needs: scenes without which it makes no sense."""

    name: str
    act: Callable[[Stage], Acting]
    needs: tuple[str, ...] = ()
    limit: float = 60.0  # s


def perform(stage: Stage, scenes: Sequence[Scene]) -> Steps:
    """Play the scenes; a failed one is kept, and those that need it are skipped."""
    for scene in scenes:
        outcome = Outcome(scene.name)
        stage.outcomes.append(outcome)
        stage.keep()
        done = {other.name for other in stage.outcomes if other.failure is None}
        missing = [name for name in scene.needs if name not in done]
        if missing:
            outcome.failure, outcome.skipped = f"needs the scene {missing[0]}", True
        else:
            begun = time.monotonic()
            print(f"SCENE {scene.name}", flush=True)
            outcome.failure = yield from _played(scene, stage)
            outcome.seconds = time.monotonic() - begun
            taking = stage.picture("FAILED_" + scene.name if outcome.failure else scene.name)
            yield from paced(taking, stage.hands)
        stage.keep()


def _played(scene: Scene, stage: Stage) -> Generator[float, None, str | None]:
    """Play one scene; its failure in words."""
    end = time.monotonic() + scene.limit
    stage.hands.task = scene.name
    acting = scene.act(stage)
    try:
        for wait in acting:
            if time.monotonic() > end:
                raise TimeoutError(f"the scene took more than {scene.limit:g} s")
            yield from patience(wait, stage.hands)
    except Exception as fault:  # noqa: BLE001 - whatever went wrong is this scene's failure
        stage.outcomes[-1].where = traceback.format_exc()
        acting.close()
        stage.gauge.stop()
        yield stage.hands.let_go() + stage.hands.key("Escape")
        return f"{type(fault).__name__}: {fault}"
    return None


def paced(acting: Acting, hands: Hands) -> Steps:
    """The same in short steps."""
    for wait in acting:
        yield from patience(wait, hands)


def patience(wait: float | Until, hands: Hands) -> Steps:
    """Waits in short steps: for a condition, or for some time and until the hands are done. Raises
    TimeoutError where that does not come."""
    seconds, limit, what = 0.0, LONGEST_ACTION, "the end of what xdotool was told"
    if isinstance(wait, Until):
        limit, what = wait.limit, wait.what
    else:
        seconds = wait
    yield seconds
    end = time.monotonic() + limit
    while not wait.holds() if isinstance(wait, Until) else hands.busy:
        if time.monotonic() > end:
            raise TimeoutError(f"{what} did not come within {limit:g} s")
        yield TICK


def run(steps: Steps, at_end: Callable[[], None]) -> None:
    """Let Blender's timer drive the play; `at_end` is called when it is over, however it ends."""

    def step() -> float | None:
        try:
            return next(steps)
        except StopIteration:
            at_end()
        except Exception:
            at_end()
            raise
        return None

    bpy.app.timers.register(step, first_interval=1.0, persistent=True)

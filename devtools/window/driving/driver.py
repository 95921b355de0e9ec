"""Scenario runner within a Blender with a window, one after another, with a record of outcomes.

A scenario is a generator that acts and yields what to wait for: seconds, or a condition with a
limit. It ends well or by an exception, which becomes the scenario's failure beside a picture of the
screen.
"""

from __future__ import annotations

import json
import subprocess
import time
import traceback
from collections.abc import Callable, Generator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import bpy

from .input_device import InputDevice
from .profiler import Profiler
from .screen import Screen

TICK = 0.01  # s between looks at a condition
LONGEST_ACTION = 20.0  # s that the input device may take for what it was told


@dataclass(frozen=True)
class Until:
    """Wait for `holds`; after `limit` seconds the scenario fails with `what` did not come."""

    what: str
    holds: Callable[[], object]
    limit: float = 10.0


Actions = Generator["float | Until", None, None]
Waits = Generator[float, None, None]


@dataclass
class Outcome:
    """Result of a scenario. failure: None where it went well, the sentence where not."""

    name: str
    seconds: float = 0.0
    failure: str | None = "it did not come to its end: Blender ended or hung"
    where: str = ""  # the failure's traceback
    skipped: bool = False
    pictures: list[str] = field(default_factory=list)


@dataclass
class Driver:
    """Input, screen and profiler for scenarios; their results are written to `out` after each."""

    out: Path
    input: InputDevice
    screen: Screen
    profiler: Profiler
    figures: dict[str, float] = field(default_factory=dict)
    outcomes: list[Outcome] = field(default_factory=list)

    def picture(self, name: str) -> Actions:
        """Keep the screen as NN_name.png, without holding up Blender meanwhile."""
        count = sum(len(outcome.pictures) for outcome in self.outcomes) + 1
        file = f"{count:02d}_{name}.png"
        taking = subprocess.Popen(["import", "-window", "root", str(self.out / file)])
        yield Until("the picture of the screen", lambda: taking.poll() is not None)
        self.outcomes[-1].pictures.append(file)

    def keep(self) -> None:
        """Write what is known so far."""
        known = {
            "scenarios": [asdict(outcome) for outcome in self.outcomes],
            "figures": self.figures,
            "profiles": {name: asdict(s) for name, s in self.profiler.profiles.items()},
            "clicks": [asdict(click) for click in self.input.clicks],
        }
        (self.out / "run.json").write_text(json.dumps(known, indent=1))


@dataclass(frozen=True)
class Scenario:
    """A named part of the run. needs: scenarios without which it makes no sense."""

    name: str
    act: Callable[[Driver], Actions]
    needs: tuple[str, ...] = ()
    limit: float = 60.0  # s


def run_scenarios(driver: Driver, scenarios: Sequence[Scenario]) -> Waits:
    """Run the scenarios; a failed one is kept, and those that need it are skipped."""
    for scenario in scenarios:
        outcome = Outcome(scenario.name)
        driver.outcomes.append(outcome)
        driver.keep()
        done = {other.name for other in driver.outcomes if other.failure is None}
        missing = [name for name in scenario.needs if name not in done]
        if missing:
            outcome.failure, outcome.skipped = f"needs the scenario {missing[0]}", True
        else:
            begun = time.monotonic()
            print(f"SCENARIO {scenario.name}", flush=True)
            outcome.failure = yield from _run_scenario(scenario, driver)
            outcome.seconds = time.monotonic() - begun
            taking = driver.picture("FAILED_" + scenario.name if outcome.failure else scenario.name)
            for wait in taking:
                yield from wait_in_steps(wait, driver.input)
        driver.keep()


def _run_scenario(scenario: Scenario, driver: Driver) -> Generator[float, None, str | None]:
    """Run one scenario; its failure in words."""
    end = time.monotonic() + scenario.limit
    driver.input.task = scenario.name
    acting = scenario.act(driver)
    try:
        for wait in acting:
            if time.monotonic() > end:
                raise TimeoutError(f"the scenario took more than {scenario.limit:g} s")
            yield from wait_in_steps(wait, driver.input)
    except Exception as fault:  # noqa: BLE001 - whatever went wrong is this scenario's failure
        driver.outcomes[-1].where = traceback.format_exc()
        acting.close()
        driver.profiler.stop()
        yield driver.input.let_go() + driver.input.key("Escape")
        return f"{type(fault).__name__}: {fault}"
    return None


def wait_in_steps(wait: float | Until, device: InputDevice) -> Waits:
    """Wait in short steps: for a condition, or for some time and until the device is done. Raises
    TimeoutError where that does not come."""
    seconds, until = 0.0, wait
    if not isinstance(until, Until):
        seconds = until
        done = "the end of what xdotool was told"
        until = Until(done, lambda: not device.busy, LONGEST_ACTION)
    yield seconds
    end = time.monotonic() + until.limit
    while not until.holds():
        if time.monotonic() > end:
            raise TimeoutError(f"{until.what} did not come within {until.limit:g} s")
        yield TICK


def drive_by_timer(steps: Waits, at_end: Callable[[], None]) -> None:
    """Let Blender's timer drive the run; `at_end` is called when it is over, however it ends."""

    def step() -> float | None:
        pause = None
        try:
            pause = next(steps, None)
        finally:
            if pause is None:
                at_end()
        return pause

    bpy.app.timers.register(step, first_interval=1.0, persistent=True)

"""Time and memory of collecting a batch, and of its page in a browser."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from ..package import ROOT
from .browser import browser

# Prints seconds and megabytes; in a process of its own, whose memory is the collecting's alone.
COLLECT = """
import runpy, sys, time
from pathlib import Path
runpy.run_path(sys.argv[1])["load"]()
from hangtime.batch.collect.collecting import collect
begun = time.perf_counter()
collect(Path(sys.argv[2]))
seconds = time.perf_counter() - begun
# Not getrusage: its peak outlives exec, so it may be that of the process that started this one.
status = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
print(seconds, int(status["VmHWM"].split()[0]) * 1024 / 1e6)
"""
PAINTED = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? 0"
READY = "document.documentElement.dataset.ready"  # ms, set by the page's last line
# From the letter typed until the frame that shows its rows was drawn.
FILTER = """
const [text] = arguments, input = document.getElementById("text");
const begun = performance.now();
input.value = text;
input.dispatchEvent(new Event("input", { bubbles: true }));
return new Promise((done) => requestAnimationFrame(
    () => setTimeout(() => done(performance.now() - begun))));
"""
SEARCHED = ("j", "ju", "jump 00", "jump 00 further", "прыжок", "")


@dataclass(frozen=True)
class CollectingTime:
    """Of collecting a batch: s, and MB at most at once, the interpreter's among them."""

    seconds: float
    megabytes: float


@dataclass(frozen=True)
class PageTime:
    """Of a page in the browser, s: until something is seen, until the table is there (either may
    come first), and the slowest of some filters."""

    first_paint: float
    ready: float
    filter: float


def measure_collecting(folder: Path) -> CollectingTime:
    """Collect a batch in a process of its own. Raises CalledProcessError."""
    command = [sys.executable, "-c", COLLECT, str(ROOT / "devtools" / "package.py"), str(folder)]
    told = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return CollectingTime(float(told[0]), float(told[1]))


def measure_page(page: Path) -> PageTime:
    """Open a batch's index.html and search in it. Raises BrowserFault."""
    with browser() as shown:
        shown.open(page)
        shown.wait(f"return ({PAINTED}) > 0")
        shown.wait(f"return {READY} !== undefined")
        painted, ready = shown.run(f"return [{PAINTED}, Number({READY})]")
        slowest = max(shown.run(FILTER, text) for text in SEARCHED)
    return PageTime(painted / 1000, ready / 1000, slowest / 1000)

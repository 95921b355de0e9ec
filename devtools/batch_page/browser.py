"""Chromium without a window, driven by chromedriver's interface (W3C WebDriver).

Standard library only: we use nine requests of that interface, and selenium is twelve packages.
"""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..environment.libraries import install

PACKAGES = ("chromium", "chromium-driver")  # Debian's names
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # WebDriver's name for a reference to one
KEYS = {"Enter": "\ue007", "Escape": "\ue00c", "Tab": "\ue004", "Home": "\ue011", "End": "\ue010"}
KEYS |= {
    "Left": "\ue012",
    "Up": "\ue013",
    "Right": "\ue014",
    "Down": "\ue015",
    "PageDown": "\ue00f",
}
SIZE = (1400, 1000)
STARTING, ANSWERING = 30.0, 60.0  # s


class BrowserFault(Exception):
    """What the browser or its driver said went wrong."""


def ensure_browser(log: Path) -> None:
    """Have Chromium and its driver. Raises SetUpError with what this machine lacks."""
    if shutil.which("chromedriver") is None:
        install(
            "The batch's page is tried in a real browser, which this machine lacks", PACKAGES, log
        )


@contextmanager
def browser(*, dark: bool = False, size: tuple[int, int] = SIZE) -> Iterator[Browser]:
    """A browser with one empty window and a profile of its own; it ends with the block."""
    process = subprocess.Popen(
        ["chromedriver", "--port=0", "--log-level=SEVERE"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        opened = Browser(f"http://127.0.0.1:{_port(process)}")
        opened.start(dark, size)
        try:
            yield opened
        finally:
            opened.request("DELETE", "")
    finally:
        process.terminate()
        process.wait(timeout=STARTING)
        if process.stdout is not None:
            process.stdout.close()


def _port(process: subprocess.Popen[str]) -> int:
    """The port that the driver listens at, which it tells in its first lines."""
    assert process.stdout is not None
    for line in process.stdout:
        _, found, port = line.rstrip(".\n ").rpartition("started successfully on port ")
        if found:
            return int(port)
    raise BrowserFault("chromedriver ended before it told its port")


@dataclass
class Browser:
    """A session of WebDriver. Every method raises BrowserFault."""

    address: str
    session: str = ""

    def start(self, dark: bool, size: tuple[int, int]) -> None:
        arguments = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage"]
        arguments += [f"--window-size={size[0]},{size[1]}", "--disable-gpu", "--no-first-run"]
        arguments += ["--blink-settings=preferredColorScheme=0"] if dark else []
        wanted = {
            "goog:chromeOptions": {"args": arguments},
            "goog:loggingPrefs": {"browser": "ALL"},
        }
        answer = self.request("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self.session = f"/session/{answer['sessionId']}"

    def request(self, method: str, path: str, content: object = None) -> Any:
        """One request of WebDriver; its answer's value."""
        data = None if content is None else json.dumps(content).encode()
        asked = urllib.request.Request(self.address + self.session + path, data=data, method=method)
        asked.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(asked, timeout=ANSWERING) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            with error:
                raise BrowserFault(json.load(error)["value"]["message"]) from error
        except OSError as error:
            raise BrowserFault(f"chromedriver does not answer: {error}") from error

    def open(self, page: Path, fragment: str = "") -> None:
        """Load a file's page, as a double click on it does."""
        self.request("POST", "/url", {"url": "about:blank"})
        self.request("POST", "/url", {"url": page.resolve().as_uri() + fragment})

    def run(self, script: str, *arguments: object) -> Any:
        """What a script's `return` in the page gives; promises are waited for."""
        return self.request("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector: str) -> str:
        """The first element of a CSS selector."""
        asked = {"using": "css selector", "value": selector}
        return str(self.request("POST", "/element", asked)[ELEMENT])

    def click(self, selector: str) -> None:
        """Click an element, as one that can be seen and reached; the one that has taken its place
        where the page was drawn anew between finding and clicking it."""
        for last in (False, False, True):
            try:
                self.request("POST", f"/element/{self.find(selector)}/click", {})
                return
            except BrowserFault as fault:
                if last or "stale element" not in str(fault):
                    raise

    def type(self, selector: str, text: str) -> None:
        """Type into an element."""
        self.request("POST", f"/element/{self.find(selector)}/value", {"text": text})

    def press(self, *keys: str) -> None:
        """Press keys one after another, where the focus is; by KEYS or single letters."""
        pressed = [KEYS.get(key, key) for key in keys]
        steps = [{"type": kind, "value": key} for key in pressed for kind in ("keyDown", "keyUp")]
        self._act({"type": "key", "id": "keys", "actions": steps})

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Press the mouse at a place of the window, pixels, and let go of it at another."""
        steps: list[dict[str, object]] = [
            _move(start),
            {"type": "pointerDown", "button": 0},
            _move(end),
            {"type": "pointerUp", "button": 0},
        ]
        self._act({"type": "pointer", "id": "mouse", "actions": steps})

    def point(self, place: tuple[float, float]) -> None:
        """Move the mouse to a place of the window, pixels."""
        self._act({"type": "pointer", "id": "mouse", "actions": [_move(place)]})

    def _act(self, device: dict[str, object]) -> None:
        self.request("POST", "/actions", {"actions": [device]})

    def complaints(self) -> list[str]:
        """What the browser's console told since it was last asked: errors and warnings."""
        entries = self.request("POST", "/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] in ("SEVERE", "WARNING")]

    def picture(self, path: Path) -> None:
        """Keep what the window shows as a PNG file."""
        path.write_bytes(base64.b64decode(self.request("GET", "/screenshot")))

    def wait(self, condition: str, seconds: float = 10.0) -> None:
        """Until a script's `return` is true."""
        end = time.monotonic() + seconds
        while not self.run(condition):
            if time.monotonic() > end:
                raise BrowserFault(f"this did not come within {seconds:g} s: {condition}")
            time.sleep(0.02)


def _move(place: tuple[float, float]) -> dict[str, object]:
    x, y = map(round, place)
    return {"type": "pointerMove", "duration": 20, "x": x, "y": y}

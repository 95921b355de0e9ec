"""Locator of buttons, tabs and points of the scene on the screen of Blender's window.

Works inside a Blender with a window. Buttons are found by going over the region with the pointer
and asking Blender what lies under it, the way its own "copy data path" and "copy Python command" do
(Ctrl-C over a button). Generators of waits, in seconds; see driver.py.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass, field
from typing import TypeVar

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from .input_device import InputDevice, Place

Result = TypeVar("Result")
Value = TypeVar("Value")
Waits = Generator[float, None, Result]

LINE = 12  # pixels between the places looked at; the smallest button is 18 high
LOOK = 0.02  # s until Blender knows what lies under the pointer
COLUMNS = (0.3, 0.7)  # of the sidebar's width, tabs left out
FOLDS = (-60, *(6,) * 8)  # notches of the wheel: up to the top, then down fold by fold
TAB_WIDTH = 24  # pixels
MARGIN = 12  # pixels beside lists and buttons
SEARCH = "a tab of the sidebar"


def present(value: Value | None) -> Value:
    """What the stubs say may be missing though it is there."""
    assert value is not None
    return value


def window_manager() -> bpy.types.WindowManager:
    """Blender's one window manager."""
    return present(bpy.context.window_manager)


class NotFound(Exception):
    """An element is not on the screen; the message names it."""


@dataclass(frozen=True)
class Spot:
    """A place of the sidebar's content: x on the screen, height as the content is scrolled."""

    x: float
    height: float


@dataclass
class Screen:
    """Finds elements of the first window's 3D viewport and its sidebar."""

    input: InputDevice
    _cache: dict[str, Spot] = field(default_factory=dict)  # places by element; tried first

    @property
    def window(self) -> bpy.types.Window:
        """Blender's first window."""
        return window_manager().windows[0]

    def area(self, kind: str = "VIEW_3D") -> bpy.types.Area:
        """The largest area of a kind. Raises NotFound."""
        areas = [area for area in self.window.screen.areas if area.type == kind]
        if not areas:
            raise NotFound(f"no area of the kind {kind}")
        return max(areas, key=lambda area: area.width * area.height)

    def has(self, kind: str) -> bool:
        """Whether the window has an area of that kind."""
        return any(area.type == kind for area in self.window.screen.areas)

    def region(self, kind: str = "WINDOW", area: str = "VIEW_3D") -> bpy.types.Region:
        return next(region for region in self.area(area).regions if region.type == kind)

    def on_screen(self, x: float, y: float) -> Place:
        """Pixels of the window (from its lower left corner) as the pointer's place."""
        return self.window.x + x, self.window.height - 1 - y

    def middle(self, kind: str = "WINDOW", area: str = "VIEW_3D") -> Place:
        """The middle of a region."""
        region = self.region(kind, area)
        return self.on_screen(region.x + region.width / 2, region.y + region.height / 2)

    def free_place(self) -> Place:
        """A place of the viewport that no panel or button covers."""
        region = self.region()
        return self.on_screen(region.x + 0.2 * region.width, region.y + 0.15 * region.height)

    def place_of(self, point: Vector) -> Place:
        """Project a point of the world to the screen. Raises NotFound outside the region."""
        region = self.region()
        space = self.area().spaces[0]
        assert isinstance(space, bpy.types.SpaceView3D)
        seen = location_3d_to_region_2d(region, present(space.region_3d), point)
        if seen is None or not (0 <= seen.x < region.width and 0 <= seen.y < region.height):
            words = f"({point.x:g}, {point.y:g}, {point.z:g})"
            raise NotFound(f"the point {words} is not in the viewport")
        return self.on_screen(region.x + seen.x, region.y + seen.y)

    def under(self) -> str:
        """Element of the sidebar under the pointer: `bpy.ops.a.b(...)`, a data path, or nothing."""
        manager = window_manager()
        kept = manager.clipboard
        area, over = self.area(), self.region("UI")
        try:
            with bpy.context.temp_override(window=self.window, area=area, region=over):
                manager.clipboard = ""
                # The stubs ask poll() for an argument that Blender does not take.
                if bpy.ops.ui.copy_python_command_button.poll():  # type: ignore[call-arg]
                    bpy.ops.ui.copy_python_command_button()
                elif bpy.ops.ui.copy_data_path_button.poll():  # type: ignore[call-arg]
                    bpy.ops.ui.copy_data_path_button(full_path=True)
                return str(manager.clipboard)
        finally:
            manager.clipboard = kept

    def find_button(self, what: str, *columns: float) -> Waits[Place]:
        """Find the sidebar's button whose command or data path has `what` in it, scrolling if
        need be. columns: where to look, in the sidebar's width. Raises NotFound."""
        for on, spot in list(self._cache.items()):
            if what in on:
                place = yield from self._bring(spot)
                if what in (yield from self.look(place)):
                    return place
                del self._cache[on]
        columns = columns or COLUMNS
        looked = dict.fromkeys(columns, math.inf)  # at all above that height, in each column
        for notches in (0, *FOLDS):
            if notches and not (yield from self._scroll(notches)):
                continue
            for column in columns:
                for place in self._column(column):
                    spot = self._spot(place)
                    if notches >= 0 and spot.height >= looked[column]:
                        continue
                    looked[column] = spot.height
                    on = yield from self.look(place)
                    if on:
                        self._cache.setdefault(on, spot)
                    if what in on:
                        return place
        raise NotFound(f"no button of the sidebar is {what}")

    def look(self, place: Place) -> Waits[str]:
        """Element at a place of the sidebar."""
        yield self.input.move(place, 0.0)
        yield LOOK
        return self.under()

    def forget(self) -> None:
        """Drop the cached places."""
        self._cache.clear()

    def _spot(self, place: Place) -> Spot:
        """A place on the screen in the sidebar's content."""
        region = self.region("UI")
        y = self.window.height - 1 - place[1] - region.y
        return Spot(place[0], region.view2d.region_to_view(0, y)[1])

    def _bring(self, spot: Spot) -> Waits[Place]:
        """Scroll until a spot of the sidebar's content can be seen, as far as that goes."""
        region = self.region("UI")
        for _ in range(20):
            y = region.view2d.view_to_region(0, spot.height, clip=False)[1]
            if y - LINE >= 0 and y + LINE < region.height:
                break
            if not (yield from self._scroll(-3 if y > 0 else 3)):
                break
        return self.on_screen(spot.x - self.window.x, region.y + y)

    def _scroll(self, notches: int) -> Waits[bool]:
        """Turn the wheel over the sidebar; whether that moved it."""
        region = self.region("UI")  # at its left edge: over a list the wheel would turn that
        edge = self.on_screen(region.x + MARGIN, region.y + region.height / 2)
        before = region.view2d.region_to_view(0, 0)[1]
        yield self.input.wheel(edge, notches)
        yield 0.2
        return bool(region.view2d.region_to_view(0, 0)[1] != before)

    def scroll_down(self, but: int = 0) -> Waits[None]:
        """Scroll to the sidebar's foot, but for some notches of the wheel."""
        yield from self._scroll(-FOLDS[0])
        if but:
            yield from self._scroll(-but)

    def _column(self, column: float) -> list[Place]:
        """Places down the sidebar, close enough that no button lies between them."""
        region = self.region("UI")
        x = region.x + column * (region.width - TAB_WIDTH)
        top = region.y + region.height - 4
        return [self.on_screen(x, y) for y in range(top, region.y + 8, -LINE)]

    def blanks(self) -> Waits[list[Place]]:
        """Places of the sidebar where no button is, from its foot upwards."""
        found = []
        for place in reversed(self._column(0.3)):
            if not (yield from self.look(place)):
                found.append(place)
        return found

    def open_tab(self, name: str) -> Waits[None]:
        """Click the sidebar's tabs, from the top, until this one is open. Raises NotFound."""
        region = self.region("UI")
        x = region.x + region.width - TAB_WIDTH / 2
        for y in range(region.y + region.height - 20, region.y, -30):
            if region.active_panel_category == name:
                self.forget()
                return
            self.input.forget(SEARCH)  # who can read clicks the right one at once
            yield self.input.click(self.on_screen(x, y), SEARCH)
            yield 0.2
        raise NotFound(f"the sidebar has no tab {name}")

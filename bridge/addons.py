"""Blender's own add-ons, at work where the artist has them switched off, too."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

import bpy  # noqa: F401  # first, for it makes the next one importable

# isort: split
import addon_utils


def has_addon(name: str) -> bool:
    """Whether this Blender comes with an add-on; some distributions' lack some."""
    return find_spec(name) is not None


@contextmanager
def addon_enabled(name: str) -> Iterator[None]:
    """Context in which an add-on is enabled; what the artist has disabled is so afterwards."""
    _, enabled = addon_utils.check(name)
    if not enabled:
        addon_utils.enable(name)
    try:
        yield
    finally:
        if not enabled:
            addon_utils.disable(name)

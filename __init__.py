"""Hangtime: adapts recorded jumps, runs and acrobatics so that the laws of motion hold."""

from contextlib import ExitStack

_registered = ExitStack()


def register() -> None:
    """Blender calls this when the extension is enabled."""
    from .ui import registration

    _registered.callback(registration.register())


def unregister() -> None:
    """Blender calls this when the extension is disabled."""
    _registered.close()

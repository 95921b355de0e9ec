"""Hangtime: adapts recorded jumps, runs and acrobatics so that the laws of motion hold."""


def register() -> None:
    """Blender calls this when the extension is enabled."""


def unregister() -> None:
    """Blender calls this when the extension is disabled."""

"""What the status bar says while something is at work, in every window."""

import bpy

from ..bridge.accessors import present


class StatusBar:
    """The text of Blender's status bars. A workspace has its own and keeps it while another is
    shown, so that it is known which have one."""

    def __init__(self) -> None:
        self._workspaces: set[int] = set()  # their numbers in this session

    def say(self, text: str) -> None:
        """In the workspaces that are shown now."""
        for window in present(bpy.context.window_manager).windows:
            with bpy.context.temp_override(window=window):
                window.workspace.status_text_set(text)
            self._workspaces.add(window.workspace.session_uid)

    def clear(self) -> None:
        """Blender's own hints again, also in workspaces that are not shown any more.

        Blender writes to the workspace of the context, and needs a window in it: not while one is
        being closed.
        """
        window = next(iter(present(bpy.context.window_manager).windows))
        for workspace in bpy.data.workspaces:
            if workspace.session_uid in self._workspaces:
                with bpy.context.temp_override(window=window, workspace=workspace):
                    workspace.status_text_set(None)
        self._workspaces.clear()

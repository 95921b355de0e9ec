"""What tests ask of a scene that holds the recorded jump of the fixtures."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.recording import BEYOND
from hangtime.tests.helpers.clips import JUMP_FRAMES

FIRST, LAST = JUMP_FRAMES
SETTLING = 3.6  # frames, 30 ms


@dataclass(frozen=True)
class SceneState:
    """What an operator that fails must leave alone."""

    actions: tuple[str, ...]
    assigned: str | None
    fake_users: tuple[bool, ...]
    objects: tuple[str, ...]
    contacts: tuple[tuple[object, ...], ...]
    status: str
    frame: float
    mode: str

    @staticmethod
    def of(armature: bpy.types.Object) -> SceneState:
        data, settings = armature.animation_data, armature.hangtime
        return SceneState(
            tuple(a.name for a in bpy.data.actions),
            data.action.name if data is not None and data.action is not None else None,
            tuple(a.use_fake_user for a in bpy.data.actions),
            tuple(o.name for o in bpy.data.objects),
            tuple((c.name, c.used, *c.at, c.start_frame, c.end_frame) for c in settings.contacts),
            settings.status,
            bpy.context.scene.frame_current_final,
            armature.mode,
        )


def landing(settings: bpy.types.PropertyGroup) -> list[bpy.types.PropertyGroup]:
    """The rows of the contacts on which the jump lands."""
    return [c for c in settings.contacts if c.phase == "ground 2"]


def drift(armature: bpy.types.Object, row: bpy.types.PropertyGroup) -> float:
    """How far, m, a contact's point gets from its place in Blender's evaluated pose.

    The first and last 30 ms apart, in which its sole sinks and rises.
    """
    take = read_recorded(armature, FIRST, LAST, BEYOND)
    schedule = analyse(take, MotionProblem(frames=(FIRST, LAST))).schedule
    contact = next(c for c in schedule.contacts if c.name == row.name)
    last = row.end_frame if row.end_frame == LAST else row.end_frame - SETTLING
    shown = read_recording(armature, first=row.start_frame + SETTLING, last=last)
    bone = shown.index(row.bone)
    points = shown.heads[:, bone] + shown.rotations[:, bone] @ contact.offset
    return float(np.linalg.norm(points - np.array(row.place), axis=1).max())


def pins(armature: bpy.types.Object) -> dict[str, Pin]:
    """The pins that the settings ask for, by name."""
    recording = read_recorded(armature, FIRST, LAST)
    return {pin.name: pin for pin in problem_of(armature.hangtime, recording).pins}


def ask_by_text(armature: bpy.types.Object, text: str) -> None:
    """Requests in the words of a recipe."""
    asked = bpy.data.texts.new("Requests")
    asked.from_string(text)
    armature.hangtime.requests = asked

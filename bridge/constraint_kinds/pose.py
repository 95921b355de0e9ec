"""Pose: joints are held at, or prefer, the recording's pose or the rest pose."""

from __future__ import annotations

from enum import Enum
from math import pi

from ...solver.data.requests import PoseRequest, Reference
from ..recipe_syntax.items import BONES, SLACK, WHEN, Kind, choice, number
from ..recipe_syntax.table import ABOVE_ZERO
from ..rows.kind import BoneUse, ConstraintKind, FieldDrawing, MenuGroup, NewRange, Row
from ..rows.row_parts import RowContext, bones_of
from ..rows.stored import angle, boolean, frame
from ..rows.stored import choice as stored_choice
from ..rows.stored import number as stored_number
from ..rows.times import when_of


class PoseSource(Enum):
    """Where a pose is taken from, as the artist reads it; the names are Reference's."""

    FIT = "Recording"
    REST = "Rest Pose"


STORED_SLACK = angle("Slack", "By how much each angle may miss it", min=0.0, max=pi)


def _record(row: Row, context: RowContext) -> PoseRequest:
    reference = Reference[row.source]
    return PoseRequest(
        row.name,
        when_of(row, context.clip),
        bones_of(row, context),
        reference=reference,
        frame=row.pose_frame if row.use_pose_frame and reference is Reference.FIT else None,
        weight=None if row.hard else row.weight,
        slack=row.slack if row.hard else 0.0,
    )


def _draw(fields: FieldDrawing, row: Row) -> None:
    layout = fields.layout
    fields.bones("The whole body")
    layout.prop(row, "source")
    if row.source == PoseSource.FIT.name:
        fields.optional(layout, "use_pose_frame", "pose_frame", "Other Frame")
    layout.prop(row, "hard")
    layout.prop(row, "slack" if row.hard else "weight")
    fields.when()


KIND = ConstraintKind(
    name="POSE",
    number=6,
    label="Pose",
    description="Hold or prefer the recording's pose or the rest pose",
    icon="ARMATURE_DATA",
    menu=MenuGroup.POSES,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "pose",
        PoseRequest,
        (
            BONES,
            choice("reference", Reference),
            number("pose_frame", attribute="frame"),
            number("weight", ABOVE_ZERO),
            SLACK,
            WHEN,
        ),
        excludes=(("weight", "slack"),),
    ),
    bones=BoneUse.SEVERAL,
    range=NewRange.FRAME,
    fields={
        "source": stored_choice("From", PoseSource),
        "use_pose_frame": boolean(
            "Of Another Frame",
            "Take the pose from one frame of the recording instead of the same frame",
        ),
        "pose_frame": frame("Pose Frame", "Frame of the recording whose pose is taken"),
        "hard": boolean(
            "Hold Exactly", "The pose is held; off, it is only preferred", default=True
        ),
        "weight": stored_number(
            "Weight", "How strongly the pose is preferred", min=0.01, default=1.0
        ),
        "slack": STORED_SLACK,
    },
)

"""Presets: several constraints at once, with sensible numbers, to be adjusted in the list.

Where the ranges and the torques come from is said in solver/body/human_limits.py and
solver/human/strength.py.
"""

from collections.abc import Iterable, Sequence
from math import degrees

import bpy
import numpy as np

from ...bridge.accessors import armature_data, present
from ...bridge.armature.traces_store import kept
from ...bridge.constraint_kinds import contact_force, torque_limit
from ...bridge.constraints.rows import (
    add_body_change,
    add_constraint,
    free_name,
    hold_in,
    hold_throughout,
    title,
)
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.rows.choices import BodyKind
from ...bridge.rows.phases import PhaseSpan, phases_of
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.analyze import USUAL_HEIGHT
from ..solve.common import required_armature
from .row_lists import AddingOperator, SelectedBonesOperator, chosen_bones

NO_LANDING = "Press Analyze first: no landing is known"
NO_FIGURE = "No bones of joints were found; choose them in the panel Bones"
SOFTER = 0.8  # of the peak that was needed
USUAL_PEAK = 3.0  # BW
WEIGHT = 10.0  # kg
MOST_NAMED = 4  # in a message
LIMIT_SLACK = np.radians(1.0)


class JointLimitsOperator(AddingOperator, bpy.types.Operator):
    bl_idname = OperatorId.JOINT_LIMITS
    bl_label = "Human Joint Limits"
    bl_description = (
        "Add limits to knees, elbows, ankles, hips, shoulders, wrists, spine and neck, as far as "
        "people can bend them (American Academy of Orthopaedic Surgeons, 1965)"
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        from ...bridge.constraints.joint_limits import joint_limits  # loads parts of the solver

        armature = required_armature(context)
        found = joint_limits(armature)
        if not found.made:
            return self.refuse(NO_FIGURE, "WARNING")
        told = [f"Added {len(found.made)} joint limits"]
        told += [f"no bone for {_listed(found.missing)}"] if found.missing else []
        beyond = sorted(
            ((by, row) for row, by in found.beyond.items() if by > LIMIT_SLACK), reverse=True
        )
        named = [f"{row} by {degrees(by):.0f}°" for by, row in beyond]
        told += [f"the recording itself goes beyond {_listed(named)}"] if beyond else []
        told += ["the recording could not be checked"] if not found.checked else []
        sure = found.checked and not (beyond or found.missing)
        self.report({"INFO" if sure else "WARNING"}, f"{'; '.join(told)}.")
        return {"FINISHED"}


class JointStrengthOperator(AddingOperator, bpy.types.Operator):
    bl_idname = OperatorId.JOINT_STRENGTH
    bl_label = "Human Torque Limits"
    bl_description = (
        "Cap the torques of hips, knees and ankles at what strong young people hold, by mass and "
        "height (Anderson, Madigan and Nussbaum, 2007)"
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        from ...bridge.constraints.rest_figure import parts_of  # loads parts of the solver
        from ...solver.body.anatomy import Side
        from ...solver.human.strength import LEG_JOINTS, peak_torque

        armature = required_armature(context)
        settings, parts = settings_of(armature), parts_of(armature)
        mass = settings.new_mass if settings.use_new_mass else settings.mass
        told, lost = [], []
        for part, joint in LEG_JOINTS.items():
            bones = [b for side in Side for b in parts.get((part, side), ())]
            if not bones:
                lost.append(joint.lower())
                continue
            row = add_constraint(armature, torque_limit.KIND, bones, 0.0)
            row.name = free_name(settings, f"{joint} Strength")
            row.torque_by = torque_limit.TorqueBy.NEWTON_METRES.name
            row.torque = peak_torque(part, mass, _height(settings))
            hold_throughout(row)
            told.append(f"{joint.lower()} {row.torque:.0f} N·m{_needed(settings, bones)}")
        if not told:
            return self.refuse(NO_FIGURE, "WARNING")
        missing = f"; no bone for {_listed(lost)}" if lost else ""
        self.report({"WARNING" if lost else "INFO"}, f"Added {', '.join(told)}{missing}.")
        return {"FINISHED"}


class SoftLandingOperator(AddingOperator, bpy.types.Operator):
    bl_idname = OperatorId.SOFT_LANDING
    bl_label = "Softer Landing"
    bl_description = "Cap the contact force of the last landing at 80 % of its peak"

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is None and _landing(required_armature(context)) is None:
            return NO_LANDING
        return why

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        landing = present(_landing(armature))
        peak = _peak(armature, landing)
        row = add_constraint(armature, contact_force.KIND, (), landing.start)
        row.name = free_name(settings_of(armature), "Softer Landing")
        hold_in(row, landing.name)
        row.use_peak, row.peak = True, USUAL_PEAK if peak is None else SOFTER * peak
        was = "its peak is not known before Adapt" if peak is None else f"it was {peak:.1f}"
        self.report({"INFO"}, f"Capped {landing.name} at {row.peak:.1f} body weights; {was}.")
        return {"FINISHED"}


class LimpLimbOperator(SelectedBonesOperator, bpy.types.Operator):
    bl_idname = OperatorId.LIMP_LIMB
    bl_label = "Limp Limb"
    bl_description = "Let the selected bones and those below them hang without any strength"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        from ...bridge.constraints.rest_figure import jointed_bones  # loads parts of the solver

        armature = required_armature(context)
        chosen = chosen_bones(armature)
        limb = _with_those_below(armature, chosen)
        jointed = jointed_bones(armature)
        bones = [bone for bone in limb if bone in jointed]
        if not bones:
            return self.refuse(
                "None of the selected bones has a joint that physics moves", "WARNING"
            )
        frame = present(context.scene).frame_current_final
        row = add_constraint(armature, torque_limit.KIND, bones, frame)
        row.name = free_name(settings_of(armature), f"Limp {title(chosen[0])}")
        row.torque_by = torque_limit.TorqueBy.NEWTON_METRES.name
        row.torque = 0.0
        others = len(limb) - len(bones)
        left_out = f"; {others} below have no joint in the physics" if others else ""
        self.report({"INFO"}, f"Made limp {_listed(bones)}{left_out}.")
        return {"FINISHED"}


class CarryWeightOperator(SelectedBonesOperator, bpy.types.Operator):
    bl_idname = OperatorId.CARRY_WEIGHT
    bl_label = "Carry Weight"
    bl_description = "Let the selected bones carry 10 kg each"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        bones = chosen_bones(armature)
        for bone in bones:
            add_body_change(settings_of(armature), BodyKind.LOAD, [bone]).mass = WEIGHT
        self.report({"INFO"}, f"{WEIGHT:.0f} kg each at {_listed(bones)}; see Body Changes.")
        return {"FINISHED"}


def _landing(armature: bpy.types.Object) -> PhaseSpan | None:
    """The last phase on the ground."""
    ground = [phase for phase in phases_of(settings_of(armature)) if phase.is_ground]
    return ground[-1] if ground else None


def _peak(armature: bpy.types.Object, phase: PhaseSpan) -> float | None:
    """The largest force, body weights, of the recording's motion or else of the last result."""
    for owner in (armature, settings_of(armature).adapted):
        found = kept(owner)
        if found is not None and found.traces.forces.size:
            traces = found.traces
            inside = (traces.frames >= phase.start) & (traces.frames <= phase.end)
            total = np.linalg.norm(traces.forces[inside].sum(axis=1), axis=1)
            return float(total.max(initial=0.0)) / traces.weight or None
    return None


def _needed(settings: HangtimeSettings, bones: Sequence[str]) -> str:
    """Of the last result, where its torques are known."""
    found = kept(settings.adapted)
    if found is None:
        return ""
    known = [b for b in bones if b in found.traces.joints]
    if not known:
        return ""
    columns = [found.traces.joints.index(bone) for bone in known]
    return f" (was {np.abs(found.traces.torques[:, columns]).max():.0f})"


def _height(settings: HangtimeSettings) -> float:
    """m."""
    if settings.use_height:
        return float(settings.height)
    return float(settings.measured_height) or USUAL_HEIGHT


def _with_those_below(armature: bpy.types.Object, names: Iterable[str]) -> list[str]:
    bones = armature_data(armature).bones
    below = {b.name for name in names for b in (bones[name], *bones[name].children_recursive)}
    return [bone.name for bone in bones if bone.name in below]


def _listed(names: Sequence[str]) -> str:
    more = len(names) - MOST_NAMED
    return ", ".join(names[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")

"""A motion file into the scene: BVH and FBX by Blender's importers, Acclaim by our own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING
from warnings import catch_warnings, simplefilter

import numpy as np

from ...solver.data.faults import NoAction, NoArmature, UnreadableClip
from ..armature.build_armature import FIRST_FRAME, build_armature
from ..formats.acclaim import USUAL_RATE, find_asf, read_acclaim
from ..formats.bvh import read_bvh
from ..formats.guess import guess_unit, guess_up, likely_unit
from ..formats.skeleton import MotionClip, UpAxis

if TYPE_CHECKING:
    import bpy

_PLAUSIBLE_HEIGHT = (0.5, 3.0)  # m
_HEIGHT_SAMPLES = 5
_AXES = {
    "Y": {"axis_forward": "-Z", "axis_up": "Y"},
    "Z": {"axis_forward": "Y", "axis_up": "Z"},
}


@dataclass(frozen=True)
class ImportedClip:
    """What came in, and how it was read.

    unit_m: m per unit of the file; of an FBX, whose units Blender converts itself, the factor
    applied after that. up: the file's axis that points up, None for an FBX, which tells it.
    """

    armature: bpy.types.Object
    unit_m: float
    unit_guessed: bool
    up: UpAxis | None
    up_guessed: bool


def import_clip(
    path: str | Path,
    *,
    unit: float | None = None,
    up: UpAxis | None = None,
    asf: str | Path | None = None,
    rate: float = USUAL_RATE,
) -> ImportedClip:
    """Import a .bvh, .fbx or .amc file as an armature with its action.

    unit: m per unit of length, up: the axis that points up (an FBX tells its own); what is not
    given is what the file tells or else guessed. asf, rate (Hz): the skeleton and rate of an AMC
    file, which tells neither. The scene gets the clip's rate, range and first frame; one file
    frame is one scene frame. Raises UnreadableClip, NonFiniteKey, and for an FBX NoArmature,
    NoAction; nothing that came in is then left behind.
    """
    path = Path(path)
    _leave_other_modes()
    with _nothing_left_on_failure():
        match path.suffix.lower():
            case ".bvh":
                return _import_bvh(path, read_bvh(path), unit, up)
            case ".amc":
                skeleton = find_asf(path) if asf is None else asf
                return _import_acclaim(read_acclaim(skeleton, path, rate), unit, up)
            case ".fbx":
                return _import_fbx(path, unit)
            case ".asf":
                problem = "is a skeleton without motion; its AMC file holds the motion"
                raise UnreadableClip(str(path), None, problem)
            case _:
                raise UnreadableClip(str(path), None, "is no BVH, FBX or AMC file")


def _import_bvh(
    path: Path, clip: MotionClip, unit: float | None, up: UpAxis | None
) -> ImportedClip:
    import bpy

    metres, axis = _settle(clip, unit, up)
    with _importer("io_anim_bvh", path):
        bpy.ops.import_anim.bvh(
            filepath=str(path),
            global_scale=metres / _metres_per_scene_unit(),
            rotate_mode="QUATERNION",
            frame_start=FIRST_FRAME,
            **_AXES[axis],
        )
    armature = bpy.context.view_layer.objects.active
    _join_quaternions(armature)
    _set_scene(clip)
    return ImportedClip(armature, metres, unit is None and clip.unit is None, axis, up is None)


def _import_acclaim(clip: MotionClip, unit: float | None, up: UpAxis | None) -> ImportedClip:
    metres, axis = _settle(clip, unit, up)
    armature = build_armature(clip, metres / _metres_per_scene_unit(), axis)
    _set_scene(clip)
    return ImportedClip(armature, metres, unit is None and clip.unit is None, axis, up is None)


def _import_fbx(path: Path, unit: float | None) -> ImportedClip:
    import bpy

    if not path.is_file():
        raise UnreadableClip(str(path), None, "cannot be opened")
    before = set(bpy.data.objects)
    with _importer("io_scene_fbx", path):
        bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
    created = [o for o in bpy.data.objects if o not in before]
    armature = _animated_armature(path, created)
    _undo_rounded_rate(armature)
    _set_range(*_key_range(armature))
    height = _height(armature)
    low, high = _PLAUSIBLE_HEIGHT
    guessed = unit is None and not low <= height <= high
    factor = likely_unit(height) if guessed else unit or 1.0
    if factor != 1.0:
        _scale_all(created, factor)
    return ImportedClip(armature, factor, guessed, None, False)


def _settle(clip: MotionClip, unit: float | None, up: UpAxis | None) -> tuple[float, UpAxis]:
    axis = up or guess_up(clip)
    return unit or clip.unit or guess_unit(clip, axis), axis


# ---------------------------------------------------------------- the scene


def _leave_other_modes() -> None:
    import bpy

    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def _metres_per_scene_unit() -> float:
    import bpy

    from ..armature.poses import metres_per_unit

    return metres_per_unit(bpy.context.scene)


def _set_scene(clip: MotionClip) -> None:
    """The clip's rate and range, one file frame on one scene frame."""
    import bpy

    render = bpy.context.scene.render
    rate = 1.0 / clip.frame_time
    render.fps = max(1, round(rate))
    render.fps_base = render.fps / rate
    _set_range(FIRST_FRAME, FIRST_FRAME + len(clip.positions) - 1)


def _set_range(first: int, last: int) -> None:
    """Also shows the first frame: the importers leave the pose of another one behind."""
    import bpy

    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = first, last
    scene.frame_set(first)


@contextmanager
def _importer(addon: str, path: Path) -> Iterator[None]:
    """Blender's importer, enabled where the artist has not; its chatter stays unprinted.

    Its complaint about the file becomes UnreadableClip.
    """
    import addon_utils

    if not addon_utils.check(addon)[1]:
        addon_utils.enable(addon)
    try:
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()), catch_warnings():
            simplefilter("ignore")  # an open file, a deprecated call: Blender's, not the artist's
            yield
    except RuntimeError as error:
        raise UnreadableClip(str(path), None, _complaint(error, path)) from error


def _complaint(error: RuntimeError, path: Path) -> str:
    """What Blender says, without its traceback and without the path, which the fault carries."""
    lines = [s for s in str(error).splitlines() if s and not s.startswith((" ", "Location:"))]
    return lines[-1].removeprefix("Error: ").replace(f" {str(path)!r}", "")


@contextmanager
def _nothing_left_on_failure() -> Iterator[None]:
    """Removes what a failed import has put into the file, and resets the scene's rate."""
    import bpy

    data, render = bpy.data, bpy.context.scene.render
    kinds = (data.objects, data.armatures, data.actions, data.meshes, data.materials, data.images)
    before = [set(kind) for kind in kinds]
    rate = render.fps, render.fps_base
    try:
        yield
    except Exception:
        added = [set(kind) - old for kind, old in zip(kinds, before, strict=True)]
        data.batch_remove(set().union(*added))
        render.fps, render.fps_base = rate
        raise


# ---------------------------------------------------------------- keys


def _join_quaternions(armature: bpy.types.Object) -> None:
    """Make neighbouring quaternions lie on one side, so that half frames are what they should be.

    Blender's importer takes each from its matrix alone.
    """
    from ..armature.fcurves import holder, keys

    by_path: dict[str, list[bpy.types.FCurve]] = {}
    for curve in holder(armature).fcurves:
        if curve.data_path.endswith("rotation_quaternion"):
            by_path.setdefault(curve.data_path, []).append(curve)
    for curves in by_path.values():
        tables = np.array([keys(curve) for curve in curves])
        values = tables[:, :, 1]
        flips = np.cumsum(np.sum(values[:, 1:] * values[:, :-1], axis=0) < 0.0) % 2 == 1
        if flips.any():
            tables[:, 1:, 1] = np.where(flips, -values[:, 1:], values[:, 1:])
            for curve, table in zip(curves, tables, strict=True):
                curve.keyframe_points.foreach_set("co", table.astype(np.float32).ravel())
                curve.update()


def _undo_rounded_rate(armature: bpy.types.Object) -> None:
    """Put an FBX's keys on whole frames: the importer placed them by the rounded rate."""
    import bpy

    base = bpy.context.scene.render.fps_base
    if base != 1.0:
        _multiply_keys(armature, ("",), 1.0 / base, 1.0)


def _multiply_keys(
    owner: bpy.types.Object, paths: tuple[str, ...], time: float, value: float
) -> None:
    """Multiply keys and handles of the owner's curves whose data path starts with one of these."""
    from ..armature.fcurves import holder

    curves = holder(owner)
    for curve in curves.fcurves if curves is not None else ():
        if curve.data_path.startswith(paths):
            for attribute in ("co", "handle_left", "handle_right"):
                table = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
                curve.keyframe_points.foreach_get(attribute, table)
                scaled = table.reshape(-1, 2) * np.array([time, value], dtype=np.float32)
                curve.keyframe_points.foreach_set(attribute, scaled.ravel())
            curve.update()


def _key_range(armature: bpy.types.Object) -> tuple[int, int]:
    first, last = armature.animation_data.action.frame_range
    return round(first), round(last)


# ---------------------------------------------------------------- FBX


def _animated_armature(path: Path, created: list[bpy.types.Object]) -> bpy.types.Object:
    """The armature with the most bones among those that move."""
    from ..armature.fcurves import holder

    armatures = [o for o in created if o.type == "ARMATURE"]
    if not armatures:
        raise NoArmature(path.name)
    armatures.sort(key=lambda armature: len(armature.data.bones), reverse=True)
    for armature in armatures:
        curves = holder(armature)
        if curves is not None and len(curves.fcurves) > 0:
            return armature
    raise NoAction(armatures[0].name)


def _height(armature: bpy.types.Object) -> float:
    """Median over the clip of the figure's vertical extent in the world, m."""
    import bpy

    scene = bpy.context.scene
    extents = []
    for frame in np.linspace(scene.frame_start, scene.frame_end, _HEIGHT_SAMPLES):
        scene.frame_set(round(frame))
        ends = [end for bone in armature.pose.bones for end in (bone.head, bone.tail)]
        extents.append(np.ptp([(armature.matrix_world @ end).z for end in ends]))
    scene.frame_set(scene.frame_start)
    return float(np.median(extents)) * _metres_per_scene_unit()


def _scale_all(created: list[bpy.types.Object], factor: float) -> None:
    """Scale everything that came in about the world's origin."""
    import bpy

    for item in created:
        if item.parent is None:
            item.location *= factor
            item.scale *= factor
            _multiply_keys(item, ("location", "scale"), 1.0, factor)
    bpy.context.view_layer.update()

"""Import of a motion file into the scene: BVH and FBX by Blender's importers, Acclaim by ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from functools import partial
from io import StringIO
from pathlib import Path
from warnings import catch_warnings, simplefilter

import bpy
import numpy as np

from ...solver.data.faults import UnknownClipFormat, UnreadableClip
from ...solver.data.reports.recording import ChosenTake
from ..accessors import current_action, current_scene, pose_of, present
from ..armature import fcurves
from ..armature.poses import metres_per_unit, set_frame_rate
from ..formats.acclaim import find_asf, read_acclaim
from ..formats.bvh import read_bvh
from ..formats.fbx_records import require_sound
from ..formats.guess import guess_unit, guess_up, likely_unit
from ..formats.motion_clip import MotionClip, UpAxis
from ..formats.paths import require_readable
from .build_armature import FIRST_FRAME, build_armature
from .data_blocks import SceneState, data_blocks, remove_added
from .fbx_takes import choose_take, places_without_keys

_PLAUSIBLE_HEIGHT = (0.5, 3.0)  # m
_HEIGHT_SAMPLES = 5


@dataclass(frozen=True)
class ImportedClip:
    """Imported armature, and how its file was read.

    unit_m: m per unit of the file; of an FBX, whose units Blender converts itself, the factor
    applied after that. up: the file's axis that points up, None for an FBX, which tells it.
    miscount: frames that a BVH announces, and that it holds, where these are more. chosen: what of
    an FBX was read, and what was not. unmoved: bones of which an AMC says nothing.
    """

    armature: bpy.types.Object
    unit_m: float
    unit_guessed: bool
    up: UpAxis | None
    up_guessed: bool
    miscount: tuple[int, int] | None = None
    chosen: ChosenTake | None = None
    unmoved: tuple[str, ...] = ()


def import_clip(
    path: str | Path,
    *,
    unit: float | None = None,
    up: UpAxis | None = None,
    asf: str | Path | None = None,
    rate: float | None = None,
    armature: str | None = None,
    take: str | None = None,
) -> ImportedClip:
    """Import a .bvh, .fbx or .amc file as an armature with its action.

    unit: m per unit of length, up: the axis that points up (an FBX tells its own); what is not
    given is what the file tells or else guessed. asf: the skeleton of an AMC file. rate: Hz, of an
    AMC file, which tells none, or in place of what a BVH tells. armature, take: which of an FBX
    that holds several. The scene gets the clip's rate, range and first frame; one file frame is one
    scene frame. Raises ClipNotOpened, UnknownClipFormat, UnreadableClip, NonFiniteKey, and for an
    FBX NoArmature, NoAction, NotInFile; nothing that came in is then left behind.
    """
    path = Path(path)
    with _nothing_left_on_failure():
        _leave_other_modes()
        match path.suffix.lower():
            case ".bvh":
                return _placed(read_bvh(path, rate), unit, up, partial(_import_bvh, path))
            case ".amc":
                require_readable(path)
                skeleton = find_asf(path) if asf is None else asf
                return _placed(read_acclaim(skeleton, path, rate), unit, up, build_armature)
            case ".fbx":
                return _import_fbx(path, unit, armature, take)
            case ".asf":
                problem = "is a skeleton without motion; its AMC file holds the motion"
                raise UnreadableClip(str(path), None, problem)
            case _:
                raise UnknownClipFormat(str(path))


def _placed(
    clip: MotionClip,
    unit: float | None,
    up: UpAxis | None,
    make: Callable[[MotionClip, float, UpAxis], bpy.types.Object],
) -> ImportedClip:
    """Settle unit and up axis of a clip; `make` gets it, its scale to Blender units, the axis."""
    axis = up or guess_up(clip)
    metres = unit or clip.unit or guess_unit(clip)
    armature = make(clip, metres / metres_per_unit(current_scene()), axis)
    _set_scene(clip)
    guessed = unit is None and clip.unit is None
    return ImportedClip(
        armature, metres, guessed, axis, up is None, clip.miscount, unmoved=clip.unmoved
    )


def _import_bvh(path: Path, _: MotionClip, scale: float, up: UpAxis) -> bpy.types.Object:
    with _importer("io_anim_bvh", path):
        bpy.ops.import_anim.bvh(
            filepath=str(path),
            global_scale=scale,
            rotate_mode="QUATERNION",
            frame_start=FIRST_FRAME,
            axis_forward="-Z" if up == "Y" else "Y",
            axis_up=up,
        )
    armature = present(present(bpy.context.view_layer).objects.active)
    # Blender's importer takes each quaternion from its matrix alone: half frames would be wrong.
    fcurves.align_quaternions(fcurves.curves_of(armature))
    return armature


def _import_fbx(
    path: Path, unit: float | None, armature_name: str | None, take: str | None
) -> ImportedClip:
    require_readable(path)
    require_sound(path)
    before = data_blocks()
    with places_without_keys() as places, _importer("io_scene_fbx", path):
        bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
    created = [o for o in bpy.data.objects if o not in before]
    actions = [action for action in bpy.data.actions if action not in before]
    armature, chosen = choose_take(
        path, created, actions, places, armature=armature_name, take=take
    )
    # The importer placed the keys by the rounded rate: at 29.97 frames a second 4124 frames became
    # 4128. Of that, and of its offset, who imports by Blender's menu is warned in export.md.
    base = current_scene().render.fps_base
    if base != 1.0:
        for curve in fcurves.curves_of(armature):
            fcurves.scale_keys(curve, 1.0 / base, 1.0)
    frame_range = present(current_action(armature)).frame_range
    _set_range(round(frame_range[0]), round(frame_range[1]))
    height = _height(armature)
    low, high = _PLAUSIBLE_HEIGHT
    guessed = unit is None and not low <= height <= high
    factor = likely_unit(height) if guessed else unit or 1.0
    if factor != 1.0:
        scale_about_origin(created, factor)
    return ImportedClip(armature, factor, guessed, None, False, chosen=chosen)


# ---------------------------------------------------------------- the scene


def _leave_other_modes() -> None:
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def _set_scene(clip: MotionClip) -> None:
    """Set the clip's rate and range, one file frame on one scene frame."""
    set_frame_rate(current_scene(), 1.0 / clip.frame_time)
    _set_range(FIRST_FRAME, FIRST_FRAME + len(clip.positions) - 1)


def _set_range(first: int, last: int) -> None:
    """Set the range and show its first frame: importers leave the pose of another one behind."""
    scene = current_scene()
    scene.frame_start, scene.frame_end = first, last
    scene.frame_set(first)


@contextmanager
def _importer(addon: str, path: Path) -> Iterator[None]:
    """Context of one of Blender's importers, enabled where the artist has not.

    Its chatter stays unprinted; its complaint about the file becomes UnreadableClip.
    """
    import addon_utils  # on the path once bpy has been imported

    if not addon_utils.check(addon)[1]:
        addon_utils.enable(addon)
    try:
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()), catch_warnings():
            simplefilter("ignore")  # an open file, a deprecated call: Blender's, not the artist's
            yield
    except RuntimeError as error:
        raise UnreadableClip(str(path), None, _complaint(error, path)) from error


def _complaint(error: RuntimeError, path: Path) -> str:
    """Blender's message without its traceback and without the path, which the fault carries."""
    lines = [s for s in str(error).splitlines() if s and not s.startswith((" ", "Location:"))]
    told = lines[-1].removeprefix("Error: ").replace(f" {str(path)!r}", "")
    return f"Blender's importer cannot read it ({told})" if "Traceback" in str(error) else told


@contextmanager
def _nothing_left_on_failure() -> Iterator[None]:
    """Roll back a failed import: remove what it has put into the file; selection, mode and the
    scene's rate, range and frame come back."""
    before, state = data_blocks(), SceneState.now()
    imported = False
    try:
        yield
        imported = True
    finally:
        if not imported:
            remove_added(before)
            state.restore()


# ---------------------------------------------------------------- FBX


def _height(armature: bpy.types.Object) -> float:
    """Median over the clip of the figure's vertical extent in the world, m."""
    scene = current_scene()
    extents = []
    for frame in np.linspace(scene.frame_start, scene.frame_end, _HEIGHT_SAMPLES):
        scene.frame_set(round(frame))
        ends = [end for bone in pose_of(armature).bones for end in (bone.head, bone.tail)]
        extents.append(np.ptp([(armature.matrix_world @ end).z for end in ends]))
    scene.frame_set(scene.frame_start)
    return float(np.median(extents)) * metres_per_unit(scene)


def scale_about_origin(objects: Iterable[bpy.types.Object], factor: float) -> None:
    """Scale objects and their animated places about the world's origin; children follow."""
    for item in objects:
        if item.parent is None:
            item.location *= factor
            item.scale *= factor
            for curve in fcurves.curves_of(item):
                if curve.data_path.startswith(("location", "scale")):
                    fcurves.scale_keys(curve, 1.0, factor)
    present(bpy.context.view_layer).update()

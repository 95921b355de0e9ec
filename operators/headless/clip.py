"""Clips from the command line: a motion file, or a .blend, to an armature and its analysis."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, floor
from pathlib import Path
from typing import TYPE_CHECKING

from ...bridge.formats.acclaim import clip_files
from ...bridge.formats.paths import require_readable
from ...bridge.recipe.recording import FileReading
from ...solver.analysis.analyse import chosen_frames
from ...solver.analysis.take import require_inside
from ...solver.data.faults import MirroredInBlender, NoArmature, NotInFile, UnreadableClip
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import BEYOND, Recording
from ...solver.data.reports.recording import ChosenTake, Origin
from ...solver.doctor.examination.repair import left_of
from ...solver.doctor.repairs import Repairs
from ...solver.doctor.stretch import Span
from ...solver.skeleton.bind_pose import bind_frames
from ...solver.worker.pipeline import Subject, measure
from ...solver.worker.stated_scale import check_scale
from ..terminal.quiet import quiet
from ..terminal.stages import Stages
from ..words.analysis_text import relative

SCENE = ".blend"

# bpy and what needs it are loaded in functions: the command line must say what is wrong with its
# arguments before Blender's module takes its second.
if TYPE_CHECKING:
    import bpy

    from ...bridge.formats.motion_clip import UpAxis
    from ...bridge.scene.skin import SkinReading


@dataclass(frozen=True)
class Clip:
    """A motion file, or a .blend with a recorded armature, and what it does not tell.

    unit: m per unit of length. up: the axis that points up. rate: Hz, of an AMC or BVH file. asf:
    an AMC file's skeleton. armature, take: which of an FBX file's; the former also of a .blend's.
    """

    path: Path
    unit: float | None = None
    up: UpAxis | None = None
    rate: float | None = None
    asf: Path | None = None
    armature: str | None = None
    take: str | None = None

    def stated(self, recipe: Path) -> FileReading:
        """What is stated of how its file is read, as a recipe at this path has it."""
        asf = None if self.asf is None else relative(self.asf, recipe)
        return FileReading(self.unit, self.up, self.rate, asf, self.armature, self.take)

    @property
    def files(self) -> tuple[Path, ...]:
        """What it is read from: its file, and an AMC file's skeleton, where there is one."""
        return clip_files(self.path, self.asf)


@dataclass(frozen=True)
class LoadedClip:
    """An imported clip: its armature and its analysis.

    problem: as it was asked for, in the recording's own lengths, after a bind pose. skin: of the
    meshes that the armature deforms. whole: first and last frame of the whole recording.
    """

    armature: bpy.types.Object
    origin: Origin
    problem: MotionProblem
    subject: Subject
    skin: SkinReading
    whole: Span

    @property
    def in_scene(self) -> bool:
        """Whether it came in a .blend, whose scene may hold more."""
        return Path(self.origin.clip).suffix.lower() == SCENE


def read_clip(clip: Clip, problem: MotionProblem) -> tuple[Recording, Span, Origin]:
    """Imports a clip as `load` does, and reads the problem's frames of it, as they are; with the
    first and last frame of the whole clip.

    Raises every Fault that a clip can have.
    """
    armature, origin = _import(clip)
    return chosen_frames(_read(armature, problem), problem), _ends(armature), origin


def load(
    clip: Clip, problem: MotionProblem, stages: Stages, repairs: Repairs | None = None
) -> LoadedClip:
    """Imports a clip into a new, empty file (a .blend is one in itself) and analyses it, repaired.

    Where no frames are asked for, a bind pose before the motion is left out.
    Raises every Fault that a clip can have.
    """
    with stages.stage("Importing the clip"):
        armature, origin = _import(clip)
        if repairs is not None:
            from ...bridge.repairs.placed_armature import repair

            repair(armature, repairs)
    with stages.stage("Finding contacts"):
        recording, whole = _read(armature, problem), _ends(armature)
        if repairs is not None:
            recording, problem = left_of(recording, problem, repairs, whole)
            check_scale(recording, problem, repairs.scale)
        count = bind_frames(recording) if problem.frames is None else 0
        if count:
            origin = replace(origin, bind_frames=count)
            problem = replace(problem, frames=recording.part(slice(count, None)).ends)
        if repairs is not None:
            problem = replace(problem, mend=repairs.mend, drift=repairs.drift, rise=repairs.rise)
        if problem.mirrored:
            raise MirroredInBlender
        read = _skin(armature, recording)
        subject = measure(recording, replace(problem, skin=read.skin))
    return LoadedClip(armature, origin, problem, subject, read, whole)


def _import(clip: Clip) -> tuple[bpy.types.Object, Origin]:
    from ...bridge.properties.attached_groups import ensure_groups

    ensure_groups()  # else armatures and actions have no place for what is noted with them
    if clip.path.suffix.lower() == SCENE:
        return _open(clip.path, clip.armature)
    import bpy

    from ...bridge.accessors import current_action, present
    from ...bridge.files.import_clip import import_clip

    # Not the factory *settings*: those would disable the extension that runs this.
    with quiet():
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    made = import_clip(
        clip.path,
        unit=clip.unit,
        up=clip.up,
        asf=clip.asf,
        rate=clip.rate,
        armature=clip.armature,
        take=clip.take,
    )
    present(current_action(made.armature)).name = clip.path.stem
    return made.armature, Origin(
        clip.path.name,
        made.unit_m,
        made.unit_guessed,
        made.up,
        made.up_guessed,
        miscount=made.miscount,
        chosen=made.chosen,
        unmoved=made.unmoved,
    )


def _open(path: Path, wanted: str | None) -> tuple[bpy.types.Object, Origin]:
    """The armature of a .blend that is wanted, else the active one, else the only one that carries
    an action."""
    import bpy

    from ...bridge.accessors import current_action, current_scene, present

    require_readable(path)
    try:
        with quiet():
            bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    except RuntimeError as error:
        problem = "Blender cannot open it, as it is damaged or no .blend file"
        raise UnreadableClip(str(path), None, problem) from error
    armatures = [o for o in current_scene().objects if o.type == "ARMATURE"]
    animated = [o for o in armatures if current_action(o) is not None]
    active = present(bpy.context.view_layer).objects.active
    if wanted is not None:
        chosen = [o for o in armatures if o.name.casefold() == wanted.casefold()]
        if not chosen:
            _require_libraries(path)
            known = tuple(sorted(o.name for o in armatures))
            raise NotInFile(str(path), "armature", wanted, known)
    else:
        chosen = [o for o in armatures if o == active] or animated
        if len(chosen) != 1:
            _require_libraries(path)
            raise NoArmature(path.name)
    armature = _recorded(chosen[0])
    others = () if wanted else tuple(sorted(o.name for o in animated if o != armature))
    action = current_action(armature)
    if action is None:
        _require_libraries(path)
    take = "" if action is None else action.name
    return armature, Origin(path.name, chosen=ChosenTake(armature.name, take, others))


def _require_libraries(path: Path) -> None:
    """Where the open .blend lacks what was looked for. Raises UnreadableClip where that may be in a
    file that it links and that is not there."""
    import bpy

    missing = [library.filepath for library in bpy.data.libraries if library.is_missing]
    if missing:
        problem = f"it links “{missing[0]}”, which is not there, and its motion may be in that"
        raise UnreadableClip(str(path), None, problem)


def _recorded(armature: bpy.types.Object) -> bpy.types.Object:
    """The armature with its recording, also where the file shows what was made of it."""
    from ...bridge.armature.actions import recorded_action, show

    action = recorded_action(armature)
    if action is not None:
        show(armature, action)
    return armature


def _read(armature: bpy.types.Object, problem: MotionProblem) -> Recording:
    from ...bridge.armature.read import read_recording

    first, last = _recorded_frames(armature, problem)
    return read_recording(armature, first=first, last=last, beyond=BEYOND)


def _skin(armature: bpy.types.Object, recording: Recording) -> SkinReading:
    from ...bridge.armature.incremental import complete
    from ...bridge.scene.skin import read_skin

    return complete(read_skin(armature, recording.frames))


def _ends(armature: bpy.types.Object) -> Span:
    """First and last frame of the whole recording."""
    from ...bridge.accessors import current_action, present, shown_range

    start, end = shown_range(armature, present(current_action(armature)))
    return float(ceil(start)), float(floor(end))


def _recorded_frames(
    armature: bpy.types.Object, problem: MotionProblem
) -> tuple[float | None, float | None]:
    """The problem's frames as far as the recording goes: beyond, Blender holds the last pose.

    Raises OutsideKeys, ClipTooShort.
    """
    from ...bridge.accessors import current_action, shown_range

    action = current_action(armature)
    if problem.frames is None or action is None:
        return None, None
    start, end = shown_range(armature, action)
    require_inside(problem.frames, armature.name, (start, end))
    return max(problem.frames[0], start), min(problem.frames[1], end)

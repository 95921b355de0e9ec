"""Blender's exporters, at work on a baked rig."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import bpy

from ...solver.data.faults import OutputNotWritable, SameUsdNames
from ..accessors import armature_data, current_scene, present
from ..addons import addon_enabled, has_addon
from ..recipe.export import ExportOptions
from ..rows.choices import FileFormat
from .baked_rig import BakedTake
from .engines import CONVENTIONS, ENDINGS, Convention, format_of
from .fbx_exporter import plain_scales, span_takes

_SKELETONS = re.compile(
    r'def Xform ("[^"]+"\s*(?:\([^)]*\)\s*)?\{(?:(?!\bdef ).)*?def Skeleton )', re.S
)

_ADDONS: Mapping[FileFormat, str] = MappingProxyType(
    {FileFormat.FBX: "io_scene_fbx", FileFormat.GLTF: "io_scene_gltf2"}
)
_UNICODE = "allow_unicode"  # an option from Blender 4.3 on


def write(
    rig: bpy.types.Object,
    names: Mapping[bpy.types.Object, str],
    takes: Sequence[BakedTake],
    target: Path,
    options: ExportOptions,
    *,
    keeps_frames: bool,
) -> None:
    """Write a baked rig, at rest where the file tells no take, and its skin, under these names. The
    scene's range and frame are left at the takes'. Raises OutputNotWritable, SameUsdNames."""
    form, convention = format_of(options), CONVENTIONS[options.engine]
    require_format(form, (bone.name for bone in armature_data(rig).bones), target)
    scene = current_scene()
    for thing in names:
        thing.select_set(True)
    present(bpy.context.view_layer).objects.active = rig
    scene.frame_start = takes[0].first
    scene.frame_end = max(scene.frame_start + 1, *(take.last for take in takes))
    scene.frame_set(scene.frame_start - 1)
    with ExitStack() as called, tempfile.TemporaryDirectory() as folder:
        called.enter_context(under_name(rig.data, names[rig], bpy.data.armatures))
        for thing, name in names.items():
            called.enter_context(under_name(thing, name, bpy.data.objects))
        made = Path(folder) / f"export{ENDINGS[form]}"
        if form in _ADDONS:
            called.enter_context(addon_enabled(_ADDONS[form]))
        if form is FileFormat.FBX:
            if keeps_frames:  # only the scene's own take does, which is called as the scene is
                called.enter_context(under_name(scene, takes[0].name, bpy.data.scenes))
            # What a viewport hides does not count as selected where that is asked.
            called.enter_context(bpy.context.temp_override(selected_objects=list(names)))
            called.enter_context(plain_scales())
            _write_fbx(made, convention, keeps_frames=keeps_frames)
            span_takes(made)
        elif form is FileFormat.GLTF:
            _write_gltf(made)
        else:
            scene.unit_settings.scale_length = 1.0  # the rig is in metres
            _write_usd(made)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(made, target)
        except OSError as error:
            raise OutputNotWritable(str(target), error.strerror or type(error).__name__) from error


def _write_fbx(path: Path, convention: Convention, *, keeps_frames: bool) -> None:
    bpy.ops.export_scene.fbx(
        filepath=str(path),
        use_selection=True,
        object_types={"ARMATURE", "MESH"},
        axis_forward="-Z" if convention.y_up else "Y",
        axis_up="Y" if convention.y_up else "Z",
        apply_scale_options="FBX_SCALE_NONE" if convention.centimetres else "FBX_SCALE_ALL",
        add_leaf_bones=False,
        bake_anim=True,
        bake_anim_use_all_bones=True,
        bake_anim_use_nla_strips=not keeps_frames,
        bake_anim_use_all_actions=False,
        bake_anim_force_startend_keying=True,
        bake_anim_simplify_factor=0.0,
    )


def _write_gltf(path: Path) -> None:
    # Blender's exporter multiplies a rate by its base in place of dividing.
    render = current_scene().render
    render.fps_base = 1.0 / render.fps_base
    bpy.ops.export_scene.gltf(
        filepath=str(path),
        export_format="GLB",
        use_selection=True,
        export_animations=True,
        export_animation_mode="NLA_TRACKS",
        export_frame_range=False,
        export_force_sampling=True,
        export_optimize_animation_size=False,
    )


def _write_usd(path: Path) -> None:
    wanted: dict[str, Any] = {
        "selected_objects_only": True,
        "export_animation": True,
        "export_armatures": True,
        "export_materials": False,
        _UNICODE: True,
    }
    known = _usd_options()
    bpy.ops.wm.usd_export(
        filepath=str(path), **{key: value for key, value in wanted.items() if key in known}
    )
    # Blender makes a SkelRoot where there is skin alone; readers look for skeletons in one.
    text = path.read_text(encoding="utf-8")
    path.write_text(_SKELETONS.sub(r"def SkelRoot \1", text), encoding="utf-8")


def usd_name(name: str) -> str:
    """A bone's name in a USD file: letters, digits and underscores, and no digit first.

    Before Blender 4.3 the letters are English ones.
    """
    if _UNICODE not in _usd_options():
        plain = re.sub(rb"\W", b"_", name.encode()).decode()
        return re.sub(r"^\d", "_", plain)
    made = re.sub(r"\W", "_", name)
    return f"_{made}" if made[:1].isdigit() else made


def require_format(form: FileFormat, bones: Iterable[str], target: Path) -> None:
    """Raises OutputNotWritable where this Blender writes no such file, SameUsdNames of bones that a
    USD file could not tell apart."""
    if form in _ADDONS:
        if not has_addon(_ADDONS[form]):
            problem = f"this Blender comes without its add-on {_ADDONS[form]}"
            raise OutputNotWritable(str(target), problem)
        return
    if not bpy.app.build_options.usd:  # as Debian's is
        raise OutputNotWritable(str(target), "this Blender was built without USD")
    taken: dict[str, str] = {}
    for bone in bones:
        other = taken.setdefault(usd_name(bone), bone)
        if other != bone:
            raise SameUsdNames(other, bone)


def _usd_options() -> list[str]:
    """What the USD exporter of this Blender can be told."""
    return list(bpy.ops.wm.usd_export.get_rna_type().properties.keys())  # type: ignore[call-arg]


@contextmanager
def under_name(block: Any, name: str, blocks: Any) -> Iterator[None]:
    """Context in which a data-block has a name, and whichever had it has another."""
    own, other = block.name, blocks.get((name, None))
    if other == block:
        yield
        return
    if other is not None:
        other.name = f"(set aside) {name}"  # of a long name the end is cut off
    block.name = name
    try:
        yield
    finally:
        block.name = own
        if other is not None:
            other.name = name

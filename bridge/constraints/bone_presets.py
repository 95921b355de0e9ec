"""Bone presets: which bone moves which part, kept as files in the extension's own user folder.

A preset is a recipe that has nothing but the table `[bones]`.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping
from pathlib import Path

import bpy

from ...solver.data.faults import BadBonePreset, BadRecipe, OutputNotWritable
from ..properties.settings import HangtimeSettings
from ..recipe.problem import parse_recipe, read_recipe_text
from ..recipe_syntax.toml_text import sections

SUFFIX = ".toml"
EMPTY = "names no bones; write a table [bones]"
_NOT_IN_FILES = re.compile(r'[\\/:*?"<>|\x00-\x1f]')  # of some system that Blender runs on
_PACKAGE = __package__.partition(".bridge")[0]


def preset_folder() -> Path:
    """Where presets are kept: the extension's folder of the user, which updates leave alone.

    Blender's own folder of settings, where the package is no installed extension.
    """
    if _PACKAGE.startswith("bl_ext."):
        return Path(bpy.utils.extension_path_user(_PACKAGE, path="bones"))
    return Path(bpy.utils.user_resource("CONFIG", path=_PACKAGE)) / "bones"


def preset_names() -> list[str]:
    """The presets that are kept, by name."""
    return sorted((path.stem for path in preset_folder().glob(f"*{SUFFIX}")), key=str.casefold)


def preset_path(name: str) -> Path:
    """The file of a preset, there or not."""
    return preset_folder() / f"{_NOT_IN_FILES.sub('_', name.strip())}{SUFFIX}"


def is_preset(name: str) -> bool:
    """Whether there is a preset of that name."""
    return bool(name.strip()) and _is_there(preset_path(name))


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # a longer name than files can have
        return False


def free_preset_name(name: str, bones: Mapping[str, str]) -> str:
    """The name, where no preset of that name says anything else; else the next that is free:
    "My Rig 2"."""
    names = (name if count == 1 else f"{name} {count}" for count in itertools.count(1))
    return next(each for each in names if not _is_there(preset_path(each)) or _says(each, bones))


def _says(name: str, bones: Mapping[str, str]) -> bool:
    """Whether a preset that is there holds just these bones."""
    try:
        return dict(read_preset(preset_path(name))) == dict(bones)
    except BadBonePreset:  # somebody edited it
        return False


def mapped_bones(settings: HangtimeSettings) -> dict[str, str]:
    """The bone of every part that has one, by label."""
    return {part.name: part.bone for part in settings.parts if part.bone}


def write_preset(path: Path, bones: Mapping[str, str]) -> None:
    """Raises OutputNotWritable."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("".join(sections("bones", bones)), encoding="utf-8")
    except OSError as error:
        raise OutputNotWritable(str(path), error.strerror or type(error).__name__) from error


def read_preset(path: Path) -> Mapping[str, str]:
    """The bones of a preset, by label; of any recipe, its table `[bones]`. Raises BadBonePreset."""
    try:
        bones = parse_recipe(read_recipe_text(path), str(path)).problem.bones
    except BadRecipe as fault:
        raise BadBonePreset(fault.path, fault.line, fault.problem) from fault
    if not bones:
        raise BadBonePreset(str(path), None, EMPTY)
    return bones

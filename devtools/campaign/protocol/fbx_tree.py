"""Damage to what an FBX file means: its tree is read and written by Blender's own add-on."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from .case import HostileCase

PARTS = (b"Objects", b"Connections", b"GlobalSettings", b"Definitions", b"Takes")
FLOATS = (float("nan"), float("inf"), -1e30, 1e308, 1e-320, 0.0, -1.0)
INTEGERS = (0, 1, -1, 2, 120, 2**31 - 1)
# By the letter of a property's type, which FBXElem's method writes it.
WRITERS = {
    **{"B": "bool", "C": "char", "Z": "int8", "Y": "int16", "I": "int32", "L": "int64"},
    **{"F": "float32", "D": "float64", "R": "bytes", "S": "string"},
    **{"i": "int32_array", "l": "int64_array", "f": "float32_array", "d": "float64_array"},
    **{"b": "bool_array", "c": "byte_array"},
}


@dataclass
class FbxNode:
    """values: each property, and in types the letter of what it is."""

    name: bytes
    types: str
    values: list[Any]
    children: list[FbxNode] = field(default_factory=list)

    def below(self) -> list[FbxNode]:
        """It and all that hang on it."""
        return [self, *(node for child in self.children for node in child.below())]


def damaged_tree(case: HostileCase, source: Path, path: Path) -> None:
    """One to four nodes of a file changed."""
    version, whole = _tree(source)
    root = deepcopy(whole)
    for _ in range(int(case.rng.integers(1, 5))):
        part = case.pick([child for child in root.children if child.name in PARTS])
        case.pick(NODE_CHANGES)(case, root, case.pick(part.below()))
    encode_bin = _addon("encode_bin")
    encode_bin.write(str(path), _encoded(encode_bin.FBXElem, root), version)


@cache
def _tree(path: Path) -> tuple[int, FbxNode]:
    parsed, version = _addon("parse_fbx").parse(str(path))
    return version, _node(parsed)


def _addon(module: str) -> Any:
    import addon_utils  # on the path once bpy has been imported

    addon_utils.enable("io_scene_fbx")
    return import_module(f"io_scene_fbx.{module}")


def _node(parsed: Any) -> FbxNode:
    types = parsed.props_type.decode()
    return FbxNode(parsed.id, types, list(parsed.props), [_node(each) for each in parsed.elems])


def _encoded(element: Any, node: FbxNode) -> Any:
    made = element(node.name)
    for letter, value in zip(node.types, node.values, strict=True):
        getattr(made, f"add_{WRITERS[letter]}")(value)
    made.elems = [_encoded(element, child) for child in node.children]
    return made


# ---------------------------------------------------------------- changes


def _value(case: HostileCase, _: FbxNode, node: FbxNode) -> None:
    """Another value of the same type in one place."""
    if not node.values:
        return
    at = int(case.rng.integers(len(node.values)))
    match node.types[at]:
        case "F" | "D":
            node.values[at] = case.pick(FLOATS[:3] if node.types[at] == "F" else FLOATS)
        case "I" | "L":
            node.values[at] = case.pick(INTEGERS)
        case "S":
            node.values[at] = case.pick((b"", b"Hips\x00\x01Model", b"x" * 300, b"\xff\xfe", b"T"))
        case "f" | "d" | "i" | "l":
            node.values[at] = _array(case, node.values[at])


def _array(case: HostileCase, values: array[Any]) -> array[Any]:
    """Cut off, turned round, or with one element of another value."""
    match int(case.rng.integers(4)):
        case 0:
            return values[: int(case.rng.integers(len(values) + 1))]
        case 1:
            return values[::-1]
    changed = values[:]
    if changed:
        odd: tuple[float, ...] = FLOATS[:3] if changed.typecode in "fd" else INTEGERS
        changed[int(case.rng.integers(len(changed)))] = case.pick(odd)
    return changed


def _borrowed(case: HostileCase, root: FbxNode, node: FbxNode) -> None:
    """A value of another node of the same name: bones that hang on others, times of other keys."""
    others = [n for n in root.below() if n.name == node.name and n.types == node.types]
    if node.values:
        at = int(case.rng.integers(len(node.values)))
        node.values[at] = case.pick(others).values[at]


def _gone(case: HostileCase, _: FbxNode, node: FbxNode) -> None:
    if node.children:
        del node.children[int(case.rng.integers(len(node.children)))]


def _twice(case: HostileCase, _: FbxNode, node: FbxNode) -> None:
    if node.children:
        node.children.append(deepcopy(case.pick(node.children)))


def _cut(_case: HostileCase, _: FbxNode, node: FbxNode) -> None:
    """Without the last of its properties."""
    node.types, node.values = node.types[:-1], node.values[:-1]


NODE_CHANGES: Sequence[Callable[[HostileCase, FbxNode, FbxNode], None]] = (
    *(_value, _value, _value, _borrowed, _borrowed, _gone, _twice, _cut),
)

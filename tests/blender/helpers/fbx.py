"""What an FBX file says, by the reader of Blender's add-on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from io_scene_fbx import parse_fbx

_TICKS = 46186158000  # in a second
_DEFAULTS = {
    b"Lcl Translation": (0.0, 0.0, 0.0),
    b"Lcl Rotation": (0.0, 0.0, 0.0),
    b"Lcl Scaling": (1.0, 1.0, 1.0),
}


@dataclass(frozen=True)
class FbxFile:
    """unit: centimetres. up: index of the axis. transformations: place, degrees and scale by node.
    takes: names of its animations. spans: start and end of its time, and of each, s."""

    unit: float
    up: int
    transformations: dict[str, tuple[float, ...]]
    takes: tuple[str, ...]
    spans: tuple[tuple[float, float], ...]


def fbx_file(path: Path) -> FbxFile:
    root = parse_fbx.parse(str(path))[0]
    settings = _properties(_child(root, b"GlobalSettings"))
    objects = _child(root, b"Objects").elems
    nodes = {}
    for each in objects:
        if each.id == b"Model":
            said = {**_DEFAULTS, **_properties(each)}
            nodes[_name(each)] = tuple(float(v) for key in _DEFAULTS for v in said[key])
    stacks = [each for each in objects if each.id == b"AnimationStack"]
    takes = tuple(_name(each) for each in stacks)
    spans = [_span(settings, b"TimeSpanStart", b"TimeSpanStop")]
    spans += [_span(_properties(each), b"LocalStart", b"LocalStop") for each in stacks]
    return FbxFile(
        settings[b"UnitScaleFactor"][0], settings[b"UpAxis"][0], nodes, takes, tuple(spans)
    )


def _span(properties: dict[bytes, tuple[Any, ...]], *names: bytes) -> tuple[float, float]:
    first, last = (properties.get(name, (0,))[0] / _TICKS for name in names)
    return first, last


def animated(path: Path, channel: str) -> dict[str, list[Any]]:
    """The values of a channel's curves, such as "Lcl Scaling", by node."""
    root = parse_fbx.parse(str(path))[0]
    objects = {each.props[0]: each for each in _child(root, b"Objects").elems}
    joined = [each.props for each in _child(root, b"Connections").elems]
    of = {props[1]: _name(objects[props[2]]) for props in joined if channel.encode() in props[3:]}
    found: dict[str, list[Any]] = {name: [] for name in of.values()}
    for _, curve, node, *_ in joined:
        if node in of and objects[curve].id == b"AnimationCurve":
            found[of[node]].append(_child(objects[curve], b"KeyValueFloat").props[0])
    return found


def _name(element: Any) -> str:
    return str(element.props[1].split(b"\x00")[0].decode())


def _child(element: Any, name: bytes) -> Any:
    return next(each for each in element.elems if each is not None and each.id == name)


def _properties(element: Any) -> dict[bytes, tuple[Any, ...]]:
    listed = _child(element, b"Properties70").elems
    return {each.props[0]: tuple(each.props[4:]) for each in listed}

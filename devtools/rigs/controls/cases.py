"""The control rigs that are measured, and which bones of each deform and hold its feet."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import bpy

from ..actor import CLIP, Actor, actor
from .auto_rig_pro import auto_rig_pro
from .rest import deform_bones
from .rigify import rigify_human

RATE, EVERY = 24, 5  # frames a second; of the recording's 120
_SEGMENT = re.compile(r"\.\d+$")


@dataclass(frozen=True)
class ControlCase:
    """A rig to measure. foot: its foot's IK control, {s} standing for the side; "" in FK."""

    key: str
    name: str
    build: Callable[[Actor], bpy.types.Object]
    deforming: Callable[[Sequence[str], tuple[str, ...]], dict[str, str]]
    foot: str = ""


def performer() -> Actor:
    """The recorded jump from standing to standing, at an animator's frame rate. Raises
    SetUpError."""
    return actor().part(*CLIP.frames, EVERY)


def cases() -> tuple[ControlCase, ...]:
    """All of them."""
    rigify = partial(rigify_human, rate=RATE)
    arp = partial(auto_rig_pro, rate=RATE)
    return (
        ControlCase("rigify_fk", "Rigify's human, FK", partial(rigify, ik=False), _of_rigify),
        ControlCase(
            "rigify_ik", "Rigify's human, IK", partial(rigify, ik=True), _of_rigify, "foot_ik.{s}"
        ),
        ControlCase("arp_fk", "As Auto-Rig Pro, FK", partial(arp, ik=False), _of_auto_rig_pro),
        ControlCase(
            "arp_ik",
            "As Auto-Rig Pro, IK",
            partial(arp, ik=True),
            _of_auto_rig_pro,
            "c_foot_ik.{s}",
        ),
    )


def _of_rigify(bones: Sequence[str], bodies: tuple[str, ...]) -> dict[str, str]:
    """The body of each bone that deforms: DEF-thigh.L.001 shares the twist of ORG-thigh.L."""
    found = {}
    for bone in bones:
        whole = _SEGMENT.sub("", bone).replace("DEF-", "ORG-")
        body = next((name for name in (bone, whole) if name in bodies), None)
        if bone.startswith("DEF-") and body is not None:
            found[bone] = body
    return found


def _of_auto_rig_pro(bones: Sequence[str], bodies: tuple[str, ...]) -> dict[str, str]:
    """The body of each bone that deforms: thigh_twist.l shares the twist of thigh.l."""
    deforming = [bone for bone in deform_bones() if bone in bones]
    found = {name: re.sub(r"_(twist|stretch)", "", name) for name in deforming}
    return {name: body for name, body in found.items() if body in bodies}

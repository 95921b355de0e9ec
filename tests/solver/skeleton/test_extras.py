"""What hangs on a body whose names tell nothing: hair, wings, armour are no head and no toe."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.layout import layouts
from hangtime.devtools.rigs.rest import rest_bones
from hangtime.solver.data.recording import Bone
from hangtime.solver.skeleton.mapping import guess_labels
from hangtime.solver.skeleton.names import names_head


@dataclass(frozen=True)
class Chain:
    """Bones that hang on a part of the body. off: m, of the first; step: m, from each to the
    next."""

    on: str
    off: tuple[float, float, float]
    step: tuple[float, float, float]
    count: int


def wing(side: float, step: tuple[float, float, float]) -> Chain:
    return Chain("spine3", (0.05 * side, 0.1, 0.1), (step[0] * side, *step[1:]), 4)


EXTRAS = {
    "hair from the crown": (Chain("head", (0.0, 0.1, 0.1), (0.0, 0.02, -0.22), 5),),
    "hair from the nape": (Chain("head", (0.0, 0.1, -0.02), (0.0, 0.02, -0.12), 5),),
    "a tail": (Chain("pelvis", (0.0, 0.1, 0.0), (0.0, 0.2, -0.1), 5),),
    "a helmet": (Chain("head", (0.0, 0.0, 0.1), (0.0, 0.0, 0.2), 1),),
    "spread wings": (wing(1.0, (0.35, 0.1, 0.05)), wing(-1.0, (0.35, 0.1, 0.05))),
    "risen wings": (wing(1.0, (0.1, 0.1, 0.25)), wing(-1.0, (0.1, 0.1, 0.25))),
    "a backpack that rises": (Chain("spine3", (0.0, 0.15, 0.0), (0.0, 0.1, 0.2), 2),),
    "a tie on the neck": (Chain("neck", (0.0, -0.05, 0.0), (0.0, -0.02, -0.1), 3),),
    "a claw on one toe": (Chain("toe.l", (0.0, 0.0, 0.0), (0.0, -0.1, 0.0), 1),),
}


def dressed(key: str, chains: Sequence[Chain]) -> list[Bone]:
    """A skeleton with what hangs on it."""
    layout = next(layout for layout in layouts() if layout.key == key)
    bones = list(rest_bones(layout, actor()))
    index = {bone.name: i for i, bone in enumerate(bones)}
    for c, chain in enumerate(chains):
        parent = index[layout.parts[chain.on]]
        head = bones[parent].head + chain.off
        for i in range(chain.count):
            tail = head + chain.step
            bones.append(Bone(f"extra{c}_{i}", parent, head, tail, np.eye(3)))
            parent, head = len(bones) - 1, tail
    return bones


def found(bones: Sequence[Bone]) -> list[str | None]:
    """The bone of every part, by its name."""
    return [guess[0] if guess is not None else None for guess in guess_labels(bones).values()]


@pytest.mark.parametrize("extra", EXTRAS)
@pytest.mark.parametrize("key", ["gibberish", "german", "japanese"])
def test_what_hangs_on_a_body_of_unknown_names_is_no_part_of_it(key: str, extra: str) -> None:
    assert found(dressed(key, EXTRAS[extra])) == found(dressed(key, ()))


def test_two_necks_are_no_head() -> None:
    """A leaf above another is the head, and no tip, where a head's place is."""
    bones = [replace(b, name=f"x{i}") for i, b in enumerate(dressed("daz", ()))]
    heads = {bone.name: other.name for bone, other in zip(bones, dressed("daz", ()), strict=True)}
    mine = guess_labels(bones)["head"]
    assert mine is not None
    assert heads[mine[0]] == "head"


@pytest.mark.parametrize("name", ["Kopf", "kopf_01", "Tête", "cabeza", "頭部", "Head"])
def test_a_head_is_called_so_in_many_languages(name: str) -> None:
    assert names_head(name)


@pytest.mark.parametrize("name", ["Head_helmet", "HeadTop", "Headband", "Hair1", "n2", "neck"])
def test_hats_and_hair_are_not(name: str) -> None:
    assert not names_head(name)

"""Deform bones that lie flat, each following a control, have the hierarchy of the controls."""

from collections.abc import Sequence
from dataclasses import replace

import pytest
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.layout import layouts
from hangtime.devtools.rigs.rest import rest_bones
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.recording import Bone
from hangtime.solver.skeleton.mapping import guess_labels

RIGS = {layout.key: layout for layout in layouts()}
FLAT, UNDER_ROOT = -1, 0


def flat_rig(key: str, deform: str, control: str, above: int) -> tuple[Bone, ...]:
    """The controls of a convention's skeleton, and a deform bone on each that is above's child.

    deform, control: what they are called, {} standing for the convention's name.
    """
    own = rest_bones(RIGS[key], actor())
    root = replace(own[0], name="rig_root", parent=-1)
    controls = [replace(b, name=control.format(b.name), parent=b.parent + 1) for b in own]
    flat = [
        replace(b, name=deform.format(b.name), parent=above, follows=control.format(b.name))
        for b in own
    ]
    return (root, *controls, *flat)


def lines(bones: Sequence[Bone], chosen: dict[str, str] | None = None) -> dict[str, str]:
    """Bones of the body by part and side; those of spine and neck by their order."""
    names = dict[str, str]()
    for segment in map_anatomy(bones, chosen):
        label = f"{segment.side.value} {segment.part.value}"
        names[f"{label} {sum(label in other for other in names)}"] = bones[segment.bone].name
    return names


RIG = ("rigify", "DEF-{}", "{}_fk")
UNKNOWN = ("unreal", "{}", "CTRL_{}")


@pytest.mark.parametrize("above", [FLAT, UNDER_ROOT])
@pytest.mark.parametrize(("key", "deform", "control"), [RIG, UNKNOWN])
def test_flat_deform_bones_hang_together_as_their_controls_do(
    key: str, deform: str, control: str, above: int
) -> None:
    flat = flat_rig(key, deform, control, above)
    own = rest_bones(RIGS[key], actor())
    assert lines(flat) == {part: deform.format(bone) for part, bone in lines(own).items()}


def test_controls_that_are_chosen_in_place_of_deform_bones_keep_their_hierarchy() -> None:
    key, deform, control = RIG
    flat = flat_rig(key, deform, control, FLAT)
    own = rest_bones(RIGS[key], actor())
    chosen = {
        label: control.format(found[0])
        for label, found in guess_labels(own).items()
        if found is not None and label != "pelvis"
    }
    assert lines(flat, chosen) == {part: control.format(name) for part, name in lines(own).items()}


def test_without_constraints_a_flat_rig_is_told_by_no_hierarchy() -> None:
    flat = [replace(bone, follows="") for bone in flat_rig(*RIG, FLAT)]
    assert guess_labels(flat)["pelvis"] is None

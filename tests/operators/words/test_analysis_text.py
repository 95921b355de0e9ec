"""The text of an analysis."""

import re
from dataclasses import replace
from pathlib import Path

from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.operators.words.analysis_text import analysis_text, starter_recipe
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.pins.pinned_places import chosen_contacts, phase_of
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.recording import Origin
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.fitted_hop import hop


def test_long_names_of_bones_leave_their_column_whole() -> None:
    """“mixamorig:RightFoot-0.050” is where a bone ran into its place."""
    recording = load_recording(JUMP)
    bones = tuple(replace(bone, name=f"mixamorig:{bone.name}") for bone in recording.bones)
    found = analyse(replace(recording, bones=bones), MotionProblem(frames=(140.0, 330.0)))
    text = analysis_text(found, Origin("jump.bvh", 1.0, False, "Y", False))
    table = text[text.index("contact ") :].splitlines()
    at = table[0].index("bone"), table[0].index("place")
    for line, contact in zip(table[1:], found.schedule.contacts, strict=True):
        assert line[: at[0]].strip().startswith(contact.name)
        assert line[at[0] : at[1]].strip() == contact.bone
        assert line[at[1] - 1] == " "


def test_a_recipe_for_a_motion_without_a_flight_speaks_of_no_jump() -> None:
    analysis = hop()
    end = analysis.schedule.flights[0].start
    standing = replace(analysis, schedule=analysis.schedule.part(0.0, end))
    for found, jumps in ((analysis, True), (standing, False)):
        text = starter_recipe(found, MotionProblem(), Path("a.bvh"), Path("a.toml"))
        assert ("jump" in text) is jumps
        assert [pin.name for pin in parse_recipe(text).problem.pins] == (
            ["Landing"] if jumps else ["Stance"]
        )


def test_a_recipe_for_a_walk_lists_its_steps_and_how_to_pin_one() -> None:
    analysis = analyse(load_recording("01_01.amc").window(1841, 2160), MotionProblem())
    text = starter_recipe(analysis, MotionProblem(), Path("a.bvh"), Path("a.toml"))
    first = re.search(r'# (step = ".*")  #', text)
    assert first is not None
    pin = parse_recipe(text.replace(first[0], f"{first[1]}  #")).problem.pins[0]
    schedule = analysis.schedule
    chosen = chosen_contacts(pin, phase_of(pin, schedule), schedule)
    (told,) = re.findall(rf"#   (.*{pin.step}.*): .* to .*", text.split("# Contacts found")[0])
    assert told.split(", ") == [schedule.contacts[i].name for i in chosen]
    assert "step" not in starter_recipe(hop(), MotionProblem(), Path("a.bvh"), Path("a.toml"))


def test_a_recipe_for_a_clip_in_which_nothing_touches_pins_nothing() -> None:
    analysis = hop()
    flying = replace(analysis, schedule=ContactSchedule((), analysis.schedule.duration, 0.0))
    text = starter_recipe(flying, MotionProblem(), Path("a.bvh"), Path("a.toml"))
    assert "Nothing touches here" in text
    assert not parse_recipe(text).problem.pins

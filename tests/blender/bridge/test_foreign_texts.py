"""Nonsense in the texts that Hangtime keeps is told in sentences, and breaks nothing."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature.actions import recorded_action
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.properties.action import action_settings
from hangtime.bridge.properties.of_actions.shown_overlaps import shown_overlaps
from hangtime.bridge.properties.of_actions.shown_times import recorded_frame
from hangtime.bridge.repairs.stored import findings, foot_faults
from hangtime.bridge.repairs.unreadable import unreadable_texts
from hangtime.bridge.rows.phases import phases_of
from hangtime.operators.solve.common import said
from hangtime.operators.timeline.timeline_bars import rows_of
from hangtime.tests.blender.helpers.rows import make_rig

NONSENSE = ("骨", "3", '{"a": 1}', "[[1]]", "[[NaN, 2]]", '[["one", "two"]]', "null")

pytestmark = pytest.mark.usefixtures("_enabled")


def told(armature: bpy.types.Object) -> list[str]:
    return [said(fault) for fault in unreadable_texts(armature)]


@pytest.mark.parametrize("stored", NONSENSE)
def test_what_carries_unseen_is_nothing_and_stops_a_solve_until_analyzed(analysed, stored) -> None:
    settings = analysed.hangtime
    before = phases_of(settings)
    settings.unseen = stored
    assert phases_of(settings) == before
    with pytest.raises(RuntimeError, match=r"“unseen” of .* cannot be read .* press Analyze"):
        bpy.ops.hangtime.adapt()
    (sentence,) = told(analysed)
    assert f"“{analysed.name}”" in sentence


@pytest.mark.parametrize("stored", [b"PK\x03\x04 and then nothing", b"", "text", 7, [1.0, 2.0]])
def test_traces_that_are_none_are_not_drawn_and_named(analysed, stored) -> None:
    assert kept(analysed) is not None
    del analysed["hangtime_traces"]
    analysed["hangtime_traces"], analysed["hangtime_traces_key"] = stored, f"another {stored}"
    assert kept(analysed) is None
    (sentence,) = told(analysed)
    assert f"“hangtime_traces” of “{analysed.name}”" in sentence
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert kept(analysed) is not None


def test_an_analysis_writes_anew_what_carries_unseen(analysed, capfd) -> None:
    analysed.hangtime.unseen = "[[NaN, 2]]"
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert told(analysed) == []
    assert "cannot be read" not in capfd.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize("stored", NONSENSE)
def test_a_results_own_texts_count_for_nothing_and_are_named(adapted, stored) -> None:
    result = adapted.hangtime.adapted
    kept = action_settings(result)
    kept.times = kept.overlaps = kept.spans = result["hangtime_unkeyed"] = stored
    assert recorded_frame(adapted, 150.0) == 150.0
    assert shown_overlaps(result, adapted=True) == ()
    source = kept.recording
    assert bpy.ops.hangtime.show_take(action=source.name) == {"FINISHED"}
    assert current_action(adapted) == source
    sentences = told(adapted)
    assert len(sentences) == 4
    for name in ("times", "overlaps", "spans", "hangtime_unkeyed"):
        assert any(f"“{name}” of “{result.name}”" in each for each in sentences)


@pytest.mark.slow
def test_a_take_whose_adapted_frames_are_not_known_is_not_adapted_again(adapted) -> None:
    result = adapted.hangtime.adapted
    bpy.ops.hangtime.start_from(result=True)
    assert recorded_action(adapted) == result
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    action_settings(result).spans = "[[1]]"
    with pytest.raises(RuntimeError, match=r"“spans” of .* show the take that it was made from"):
        bpy.ops.hangtime.adapt()


@pytest.mark.parametrize("stored", NONSENSE)
def test_findings_that_are_none_are_left_out_until_it_is_examined(stored) -> None:
    armature = make_rig()
    settings = armature.hangtime
    for name, field in (("spike", "frames"), ("floor", "remedy"), ("time scale", "other")):
        row = settings.findings.add()
        row.name = name
        setattr(row, field, stored)
    settings.findings.add().name = "a kind of another version"
    settings.feet = stored
    assert findings(settings) == []
    assert foot_faults(settings) == ()
    assert all(not bar.is_doubt for row in rows_of(settings, float) for bar in row.bars)
    assert not bpy.ops.hangtime.repair_all.poll()
    for kind in ("spike", "a kind of another version"):
        with pytest.raises(RuntimeError, match="press Examine"):
            bpy.ops.hangtime.show_finding(kind=kind)
    sentences = told(armature)
    assert len(sentences) == 2
    assert all("press Examine" in each for each in sentences)


@pytest.mark.slow
def test_an_examination_writes_its_texts_anew(jump) -> None:
    jump.hangtime.feet = "3"
    jump.hangtime.findings.add().name = "骨"
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert told(jump) == []
    assert findings(jump.hangtime) == []


@pytest.mark.parametrize(
    "stored", ['{"scale": "2"}', '{"floor": NaN}', '{"scale": 0}', '{"missing": [[3, 100000000]]}']
)
def test_repairs_beyond_reason_cannot_be_read(jump, stored) -> None:
    jump.hangtime.repairs = stored
    with pytest.raises(RuntimeError, match="repairs cannot be read"):
        bpy.ops.hangtime.analyze()

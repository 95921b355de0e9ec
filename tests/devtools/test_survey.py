"""The survey: its recipes are recipes, jumps are found, and how an edit ended is told."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hangtime.devtools.environment.problem import SetUpError
from hangtime.devtools.survey import solve
from hangtime.devtools.survey.main import chosen, tell
from hangtime.devtools.survey.result import EditEnding, EditResult, kinds
from hangtime.devtools.survey.solve import edited
from hangtime.devtools.survey.table import table
from hangtime.devtools.survey.windows import AROUND, QUICK, Window, edits, held, spread, window
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import Character
from hangtime.solver.data.contacts import Contact, ContactSchedule
from hangtime.solver.data.faults import OutOfReach
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, fitted_hop, frames_of


@pytest.fixture(scope="module")
def hop() -> Window:
    found = window(load_recording(HOP_CLIP), frames_of(HOP_CLIP, HOP))
    assert found is not None
    return found


def result(edit: str, ending: EditEnding, seconds: float, steps: int) -> EditResult:
    return EditResult("clip", (1.0, 9.0), edit, ending, seconds, steps, "words")


@pytest.mark.parametrize("edit", edits())
def test_every_edit_asks_for_something_on_the_bones_of_the_clip(hop: Window, edit: str) -> None:
    problem = hop.problem(edit)
    assert problem.frames == hop.frames
    assert problem.pins or problem.requests != type(problem.requests)()


def test_a_window_is_a_flight_between_its_grounds(hop: Window) -> None:
    assert (hop.before.end, hop.after.start) == (hop.flight.start, hop.flight.end)
    assert window(load_recording(HOP_CLIP), (1.0, 40.0)) is None  # before any flight


def test_flights_are_spread_and_windows_do_not_overlap() -> None:
    def stand(start: float, end: float) -> Contact:
        return Contact("Toe 1", "Toe", "foot", np.zeros(3), start, end, np.zeros(3))

    grounds = [(2.0 * k, 2.0 * k + 1.6) for k in range(20)]
    schedule = ContactSchedule(tuple(stand(*ground) for ground in grounds), 39.6, 0.0)
    found = spread(schedule)
    assert len(found) == 4
    assert found[0][0] == pytest.approx(1.6)
    assert all(b[0] - a[1] >= 2.0 * AROUND for a, b in pairwise(found))


def test_a_recording_without_a_flight_is_told_and_is_no_success(tmp_path: Path) -> None:
    crouching = load_recording(HOP_CLIP).window(1.0, 40.0)
    (found,) = solve.survey("clip", crouching, ["landing_further"])
    assert found.ending is EditEnding.SKIPPED
    assert found.said.startswith("Nothing flies in it")
    assert tell([found], [], 1.0, tmp_path) == 1


def test_an_edit_that_is_refused_is_told_impossible(
    hop: Window, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OutOfReach("Landing", "Take-off", 9.0, 0.5)

    monkeypatch.setattr(solve, "adapt_fit", refuse)
    found = edited("clip", hop, fitted_hop(), "landing_further")
    assert found.ending is EditEnding.IMPOSSIBLE
    assert "Landing" in found.said


def test_an_exception_that_is_no_fault_is_a_crash_and_fails_the_survey(
    hop: Window, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def crash(*_: object) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr(solve, "adapt_fit", crash)
    found = edited("clip", hop, fitted_hop(), "landing_further")
    assert (found.ending, found.said) == (EditEnding.CRASHED, "RuntimeError: a bug")
    assert tell([found], [], 1.0, tmp_path) == 1
    assert tell([result("a", EditEnding.MISSED, 1.0, 1)], [], 1.0, tmp_path) == 0
    assert tell([], [], 1.0, tmp_path) == 1


def test_an_edit_of_a_part_that_the_figure_lacks_is_skipped_by_name(
    hop: Window, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = Character.body

    def headless(figure: Character, part: Part, side: Side = Side.MIDDLE) -> int | None:
        return None if part in (Part.HEAD, Part.NECK) else whole(figure, part, side)

    monkeypatch.setattr(Character, "body", headless)
    found = edited("clip", hop, fitted_hop(), "head_in_a_cone")
    assert found.ending is EditEnding.SKIPPED
    assert found.said == "The figure has no head that moves by itself."
    assert hop.problem("landing_further").pins  # is about no head
    other = result("head_in_a_cone", EditEnding.SOLVED, 3.0, 7)
    (kind,) = kinds([found, other])
    assert (kind.count(EditEnding.SKIPPED), kind.seconds, kind.steps) == (1, 3.0, 7)


def test_the_table_counts_endings_and_names_the_slowest(tmp_path: Path) -> None:
    results = [
        result("pin", EditEnding.SOLVED, 1.0, 2),
        result("pin", EditEnding.MISSED, 5.0, 9),
        result("pin", EditEnding.SOLVED, 2.0, 3),
        result("load", EditEnding.IMPOSSIBLE, 0.0, 0),
    ]
    pin, load = kinds(results)
    assert (pin.count(EditEnding.SOLVED), pin.seconds, pin.slowest.seconds) == (2, 2.0, 5.0)
    assert (load.count(EditEnding.IMPOSSIBLE), pin.most_steps) == (1, 9)
    assert len(table(results).splitlines()) == 4
    assert tell(results, [], 1.0, tmp_path) == 0
    written = json.loads((tmp_path / "survey.json").read_text())
    assert [each["ending"] for each in written["edits"]][1] == "missed"


def test_recordings_are_chosen_by_name_or_folder(tmp_path: Path) -> None:
    (tmp_path / "mine.bvh").touch()
    assert list(chosen([QUICK[0], str(tmp_path)])) == [QUICK[0], "mine"]
    assert QUICK[0] in held()
    with pytest.raises(SetUpError, match="'nobody' is no recording and no folder"):
        chosen(["nobody"])

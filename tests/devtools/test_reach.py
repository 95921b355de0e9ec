"""The table of reaches: means over jumps, a figure that is no human beside a person."""

from hangtime.devtools.reach.main import JOINTS, REACHES, ReachResult, rows


def result(jump: str, reach: str, human: bool, degrees: float) -> ReachResult:
    joints = dict.fromkeys(JOINTS, degrees) | {"hip": 10.0}
    return ReachResult(jump, reach, human, True, 2.0, joints)


def test_rows_are_means_over_the_jumps_of_each_reach_and_measure() -> None:
    results = [
        result(jump, reach.name, human, degrees + (20.0 if human else 0.0))
        for jump, degrees in (("a", 10.0), ("b", 30.0))
        for reach in REACHES
        for human in (False, True)
    ]
    head, _, *lines = rows(results)
    assert len(lines) == 2 * len(REACHES)
    names, *cells = ([cell.strip() for cell in line.split("|")] for line in (head, *lines[:2]))
    plain, person = (dict(zip(names, row, strict=True)) for row in cells)
    assert (plain["spine"], person["spine"]) == ("20", "40")
    assert (plain["spine / hip"], person["spine / hip"]) == ("2.0", "4.0")
    assert plain["seconds"] == "2.0"

"""Solver options of a recipe: method, objectives and reduction. Keys: see requests.py."""

from ...solver.data.solver_options import (
    MIN_SPAN,
    Dynamics,
    HumanRanges,
    Method,
    ObjectiveKind,
    Reduction,
    ReductionKind,
    ShapeSource,
    SolverOptions,
)
from ..recipe_syntax.items import Kind, Values, angle, choice, flag, number, one, whole
from ..recipe_syntax.table import NOT_NEGATIVE, NumberRange, Table, listed

Rows = tuple[tuple[tuple[str, tuple[float, ...]], ...], ...]

COUNT = NumberRange("a whole number above zero", lambda value: value > 0.0 and value.is_integer())
PART_OF_ALL = NumberRange("above 0 and at most 1", lambda value: 0.0 < value <= 1.0)
A_SPAN = NumberRange(f"at least {MIN_SPAN:g} s", lambda value: value >= MIN_SPAN)
CHOSEN_BY_HAND = (ReductionKind.MATRIX, ReductionKind.MIRROR_LEGS)


def _objectives(table: Table, key: str) -> tuple[tuple[ObjectiveKind, float], ...]:
    weights = table.table(key, [member.value for member in ObjectiveKind], "objective")
    if not weights.values:
        table.refuse(key, f"nothing to weigh; known: {listed(weights.known)}")
    return tuple((ObjectiveKind(k), weights.number(k, NOT_NEGATIVE) or 0.0) for k in weights.values)


def _weights(objectives: tuple[tuple[ObjectiveKind, float], ...]) -> Values:
    return {objective.value: weight for objective, weight in objectives}


def _matrix(table: Table, key: str) -> Rows:
    rows = table.values[key]
    form = 'write every row as [{ bone = "...", weights = [...] }, ...]'
    if not isinstance(rows, list) or not rows or not all(rows):
        table.refuse(key, form)
    return tuple(
        tuple(map(_combined, table.inner((key, i), row, ("bone", "weights"), form)))
        for i, row in enumerate(rows)
    )


def _combined(table: Table) -> tuple[str, tuple[float, ...]]:
    table.needs(("weights",))
    return table.needed_word("bone"), table.all_numbers("weights")


def _rows(matrix: Rows) -> tuple[tuple[Values, ...], ...]:
    return tuple(
        tuple({"bone": bone, "weights": weights} for bone, weights in row) for row in matrix
    )


def _read_reduction(table: Table, key: str) -> Reduction:
    inside = table.table(key, REDUCTION.keys, "key")
    reduction = REDUCTION.read(table)
    if (reduction.kind is ReductionKind.MATRIX) != bool(reduction.matrix):
        wrong = "matrix" if reduction.matrix else "kind"
        inside.refuse(wrong, 'kind = "matrix" and a "matrix" go together; add the other')
    for choice_key in ("dimensions", "explained"):
        if choice_key in inside.values and reduction.kind in CHOSEN_BY_HAND:
            inside.refuse(choice_key, f'"{reduction.kind.value}" needs no "{choice_key}"; drop it')
    return reduction


def _human(table: Table, key: str) -> HumanRanges:
    """true, false or "hard"."""
    if isinstance(table.values[key], bool):
        return HumanRanges.SOFT if table.flag(key) else HumanRanges.OFF
    return table.choice(key, HumanRanges) or HumanRanges.SOFT


def _human_words(human: HumanRanges) -> bool | str:
    return human.value if human else False


REDUCTION = Kind(
    "reduction",
    Reduction,
    (
        choice("kind", ReductionKind),
        whole("dimensions", COUNT),
        number("explained", PART_OF_ALL),
        one("matrix", _matrix, _rows),
    ),
    needs=(("kind",),),
    excludes=(("dimensions", "explained"),),
    named=False,
)
SOLUTION = Kind(
    "solution",
    SolverOptions,
    (
        choice("method", Method),
        choice("dynamics", Dynamics),
        flag("keep_times"),
        flag("solid"),
        choice("shapes", ShapeSource),
        one("human", _human, _human_words),
        angle("wider", NOT_NEGATIVE),
        number("longest_span", A_SPAN),
        number("torque_span", A_SPAN),
        one("objectives", _objectives, _weights),
        one("reduction", _read_reduction, REDUCTION.write),
    ),
    named=False,
)

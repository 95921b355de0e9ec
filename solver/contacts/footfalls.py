"""Footfalls: what of a leg touches from where it comes down to where it leaves."""

from collections.abc import Sequence

from ..data.contacts import Touch


def footfalls(touches: Sequence[Touch]) -> tuple[tuple[int, ...], ...]:
    """Indices of touches, those of each leg or arm together that share some time with each other
    or with one between them: from where a foot comes down to where it leaves; by their starts."""
    found: list[list[int]] = []

    def goes_on(mine: Sequence[int], touch: Touch) -> bool:
        until = max(touches[i].end for i in mine)
        rolls = until == touch.start and all(touches[i].point != touch.point for i in mine)
        return touches[mine[0]].leg == touch.leg and (until > touch.start or rolls)

    for i in sorted(range(len(touches)), key=lambda i: touches[i].start):
        mine = next((step for step in found if goes_on(step, touches[i])), None)
        if mine is None:
            found.append([i])
        else:
            mine.append(i)
    return tuple(map(tuple, found))


def takes_steps(touches: Sequence[Touch]) -> bool:
    """Whether a limb comes down again, as in a walk."""
    legs = [touches[mine[0]].leg for mine in footfalls(touches)]
    return len(set(legs)) < len(legs)


def stood_on_first(touches: Sequence[Touch]) -> frozenset[int]:
    """Indices of touches: those of the foot that comes down first, and of the other one where both
    stand together for most of a step, as after a jump, not in a walk's change of feet."""
    steps = [(_while(touches, mine), mine) for mine in footfalls(touches)]
    (first, last), _ = min(steps, key=lambda step: step[0])

    def together(start: float, end: float) -> bool:
        shared = min(end, last) - max(start, first)
        return 2.0 * shared > min(end - start, last - first)

    return frozenset(i for when, mine in steps if together(*when) for i in mine)


def _while(touches: Sequence[Touch], step: Sequence[int]) -> tuple[float, float]:
    return min(touches[i].start for i in step), max(touches[i].end for i in step)

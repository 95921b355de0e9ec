"""The longest part of a recording that nothing cuts: what is worth keeping of it."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from .finding import Finding, FindingKind

CUTTING = (FindingKind.BIND_POSE, FindingKind.JUMP, FindingKind.LEAP)
Span = tuple[float, float]


def cuts(finding: Finding) -> list[Span]:
    """The last frame before and the first one after each place of a finding. A jump is between two
    frames, which both are sound."""
    if finding.kind is FindingKind.JUMP:
        return list(finding.frames)
    return [(first - 1.0, last + 1.0) for first, last in finding.frames]


def is_clear(span: Span, finding: Finding) -> bool:
    """Whether the frames of a span have no place of a finding among them."""
    return not any(span[0] < after and before < span[1] for before, after in cuts(finding))


def belonging(span: Span, findings: Iterable[Finding]) -> Span:
    """The span and as much around it as nothing cuts off from it."""
    found = [cut for finding in findings for cut in cuts(finding)]
    first = max((after for _, after in found if after <= span[0]), default=-inf)
    last = min((before for before, _ in found if before >= span[1]), default=inf)
    return first, last


def longest_stretch(span: Span, findings: Iterable[Finding]) -> Span:
    """First and last frame of the longest part of a span without any place of these findings; of
    two as long the later one, for beginnings are spoilt more often. Where none is left, the last is
    before the first."""
    start, parts = span[0], list[Span]()
    for before, after in sorted(cut for finding in findings for cut in cuts(finding)):
        parts.append((start, min(before, span[1])))
        start = max(start, after)
    parts.append((start, span[1]))
    return max(reversed(parts), key=lambda part: part[1] - part[0])

"""What an artist changes of a figure's solid shapes: thickness, and what may go through what."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

from ..body.character import Character
from ..data.faults import BeyondReason, NotAboveZero
from ..data.requests import Shape, Through
from .flesh import Flesh

MOST_THICKNESS = 10.0  # a shin as wide as two metres
NO_FLESH: Mapping[int, Flesh] = MappingProxyType({})


@dataclass(frozen=True)
class ShapeChanges:
    """By bodies' indices. thickness: scale factors, of others 1. loose: what goes through all.

    together: groups whose bodies may be in each other. flesh: of bodies that have a mesh.
    """

    thickness: Mapping[int, float] = field(default_factory=dict)
    loose: frozenset[int] = frozenset()
    together: tuple[frozenset[int], ...] = ()
    flesh: Mapping[int, Flesh] = field(default_factory=dict)

    @staticmethod
    def of(
        shapes: Sequence[Shape], character: Character, flesh: Mapping[int, Flesh] = NO_FLESH
    ) -> "ShapeChanges":
        """As the requests say; factors of one bone multiply. Raises StillBone, NotAboveZero,
        BeyondReason."""
        thickness: dict[int, float] = {}
        loose: set[int] = set()
        together: list[frozenset[int]] = []
        for shape in shapes:
            if not shape.thickness > 0.0:
                raise NotAboveZero(shape.name, shape.thickness)
            bodies = frozenset(character.moved_by(shape.name, bone) for bone in shape.bones)
            for body in bodies:
                thickness[body] = shape.thickness * thickness.get(body, 1.0)
                if thickness[body] > MOST_THICKNESS:
                    raise BeyondReason(shape.name, thickness[body], MOST_THICKNESS)
            if shape.through is Through.ALL:
                loose |= bodies
            elif shape.through is Through.EACH_OTHER:
                together.append(bodies)
        return ShapeChanges(thickness, frozenset(loose), tuple(together), flesh)

    def factor(self, body: int) -> float:
        """On a body's thickness."""
        return self.thickness.get(body, 1.0)

    def may_pass(self, one: int, other: int) -> bool:
        """Whether two bodies may be in each other."""
        both = {one, other}
        return bool(both & self.loose) or any(both <= group for group in self.together)


AS_IS = ShapeChanges()

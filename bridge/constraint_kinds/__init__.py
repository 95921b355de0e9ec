"""The kinds of constraints, one module each: a new one need only lie in this folder.

A module declares `KIND`; CONTRIBUTING.md tells how. They load without Blender.
"""

from collections.abc import Mapping
from importlib import import_module
from pkgutil import iter_modules

from ..rows.kind import ConstraintKind
from ..rows.stored import Fields, Stored


def _found() -> dict[str, ConstraintKind]:
    """Every module's kind by its stored name, in the order of the stored numbers.

    Raises ValueError where two share a name or a number.
    """
    modules = (import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__))
    kinds: list[ConstraintKind] = sorted((m.KIND for m in modules), key=lambda kind: kind.number)
    for key in ("name", "number", "requests"):
        if len({getattr(kind, key) for kind in kinds}) < len(kinds):
            raise ValueError(f"two kinds of constraints have the same {key}")
    return {kind.name: kind for kind in kinds}


def stored_fields() -> Fields:
    """The fields of all kinds. Raises ValueError where kinds that share one differ about it."""
    fields: dict[str, Stored] = {}
    for kind in KINDS.values():
        for name, stored in kind.fields.items():
            if fields.setdefault(name, stored) != stored:
                raise ValueError(f"{kind.label} stores {name} otherwise than another kind")
    return fields


KINDS: Mapping[str, ConstraintKind] = _found()

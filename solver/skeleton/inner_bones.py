"""The body's bones within a rig whose parents do not tell them: Auto-Rig Pro's with its controls.

There a forearm, a hand, a foot hang on the root's control and follow the chains of IK and FK by
constraints, which a skeleton alone does not show; so names tell what hangs on what. Its limbs'
bones that deform share out a limb's twist; those without are one for each part.
"""

import re
from collections.abc import Iterable
from itertools import pairwise

MARKS = frozenset({"c_traj", "c_root_master.x", "root.x", "head.x"})  # exported rigs lack the first
_SPINE, _NECK = re.compile(r"spine_\d+\.x"), re.compile(r"(?:subneck_\d+|neck)\.x")
_ARM = ("shoulder.{side}", "arm.{side}", "forearm.{side}", "hand.{side}")
_LEG = ("thigh.{side}", "leg.{side}", "foot.{side}", "toes_01.{side}")


def inner_parents(names: Iterable[str]) -> dict[str, str | None]:
    """The bone above each bone of the body, by name; empty where the rig is no such one."""
    there = set(names)
    if not there >= MARKS:
        return {}
    spine = ["root.x", *sorted(filter(_SPINE.fullmatch, there))]
    # Of a divided neck the last bone is called as one alone is.
    neck = sorted(filter(_NECK.fullmatch, there), key=lambda name: (name == "neck.x", name))
    lines = [[*spine, *neck, "head.x"]]
    for side in "lr":
        for above, limb in ((spine[-1], _ARM), (spine[0], _LEG)):
            bones = [name.format(side=side) for name in limb]
            lines.append([above, *(bone for bone in bones if bone in there)])
    found: dict[str, str | None] = {"root.x": None}
    found.update((below, above) for line in lines for above, below in pairwise(line))
    return found

"""Requests in a recipe: what may be asked for beside pins, and how it is written.

Every table may have a `name`, by which it is reported; no two, nor a pin, may share one. Angles
are in degrees, lengths in m, times in s, frames are the scene's, and vectors are [x, y, z].

*When.* Tables marked (when) hold throughout, or
    phase = "flight 1"          # during a phase, as the analysis prints it, or a hold's name
    frames = [140, 160]         # or from frame to frame, of the phase where both; or frame = 150
    moment = "apex"             # only then: start, middle, apex or end of the phase or frames

[[point]]                       # a point of a bone is held at, or within bounds of, a place (when)
bone = "Hand.L"
offset = [0, 0.1, 0]            # from the bone's head, in its axes; default: its middle
place = [1, 0, 2.4]             # in the world; default: where the recording has it
path = [{ frame = 140, place = [1, 0, 2] }, { frame = 150, place = [1, 0.5, 2] }]  # it moves:
                                # frames of the result, also where its phases last longer
relative = [0, 0, 0.1]         # m off the place, in `axes`; or forward, up, left, back, right, down
at_least = { z = 0.3 }          # bounds about the place instead of the place itself; by axis:
at_most = { z = 0.5 }           # x, y, z; forward, left, up; or along, across, out of a surface
axes = "world"                  # or "travel", "surface"; need not be said where the names say it
normal = [0, -1, 0]             # of the surface of `axes`, or of what pushes back; else of the
                                # object's face there, or up
environment = true              # what is there pushes back with a force;
grip = true                     # ... and pulls, too

[[lift]]                        # contacts shall not touch in a phase
phase = "ground 2"
points = ["Left heel"]          # or bones = [...]; default: everything that touches in the phase

[[angle]]                       # how far a joint is bent (when)
bone = "Shin.L"
at_least = 10                   # -360 to 360; and / or at_most; or fixed = 90

[[twist]]                       # how far a bone is turned about itself; keys as for angle (when)

[[cone]]                        # a bone stays in a cone (when)
bone = "Thigh.L"
half_angle = 40
axis = [0, 0, -1]               # in the rest pose; default: where the recording points, on average
stretch = [1, 1.5]              # wider sideways, forwards

[[torque]]                      # of the bones' joints to their parents (when)
bones = ["Foot.L"]
bound = 50                      # N·m of muscle; or share = 0.5 of the recording's peak; 0 is limp
value = 20                      # N·m, about which the bound lies; default: 0
dof = 0                         # only this angle of the joint: 0, 1 or 2

[[pose]]                        # joints are posed as in the recording (when)
bones = ["Thigh.L", "Shin.L"]   # default: the whole body
reference = "fit"               # or "rest"
pose_frame = 150                # the recording's frame that is taken; default: the same frame
slack = 2                       # by which each angle may miss it; or
weight = 1                      # it is only preferred, this much

[[orientation]]                 # how a bone points in the world (when)
bone = "Hips"
turn = 180                      # about the vertical, counter-clockwise from above
tilt = 10                       # forwards
slack = 2

[[force]]                       # forces of contacts (when)
points = ["Left heel"]          # or bones = [...]; default: all contacts
friction = 0.8                  # coefficient
shape = "exact"                 # or "pyramid", of the friction cone
peak = 3                        # body weights on Earth, 9.81 N a kg
match = 10                      # how much more than usual they are kept as they were

[[clear]]                       # the way goes over an object of the scene
object = "Hurdle"
by = 0.05                       # m above it; default: 0
bones = ["LeftFoot"]            # default: the whole body

[[shape]]                       # what is no flesh: hair, cloth, what a hand holds
bones = ["Hair", "Cape"]
thickness = 0.5                 # times as thick, where limbs, floor and scene meet it
through = "all"                 # or "each other": these bones may go through one another
human = false                   # the joints of these bones may go beyond what a person's can

[body]
mass = 80                       # kg; default: the recording's
gravity = 1.62                  # m/s²
[[load]]                        # a mass that is carried
bone = "Hand.R"
share = 0.2                     # of the body's mass; or mass = 14
offset = [0, 0.1, 0]            # from the bone's head, in its axes; default: the bone's tail
[[limb]]
bones = ["Thigh.L", "Shin.L"]
length = 0.8                    # times
mass = 0.8                      # times

[[timing]]
phase = "flight 1"
factor = 1.5                    # or seconds = 0.6
[[hold]]                        # a frame is repeated, as a phase of its own by this name
name = "Hanging"
frame = 150
seconds = 1
ends = true                     # what came after it is left out

[solution]
method = "implicit"             # or "implicit with torques", "explicit"
dynamics = "automatic"          # or "reduced", "standard"
keep_times = true               # phases that no timing names last as long as recorded
solid = false                   # limbs and floor may go through each other
shapes = "bones"                # the body is as thick as its mass; default: as the skinned mesh
human = false                   # joints may go beyond what a person's can; or "hard": never
wider = 10                      # degrees, by which joints may go further than a person's
longest_span = 0.1              # s between knots, from 0.015 on; torque_span: of the torques
[solution.objectives]           # weights, of the explicit solution
"torque smoothness" = 1         # power, torque output, mass displacement, angle displacement,
closeness = 1                   # angle smoothness, total change
[solution.reduction]
kind = "pca"                    # or varimax, quartimax, oblique, ica, mirror legs, matrix
dimensions = 16                 # or explained = 0.99 of the variance
matrix = [[{ bone = "Thigh.L", weights = [1, 0, 0] }, { bone = "Thigh.R", weights = [1, 0, 0] }]]
"""

from collections.abc import Collection
from typing import Any

from ...solver.data.requests import (
    AddedMass,
    BodyChange,
    Clear,
    LimbChange,
    PointRequest,
    Requests,
    Shape,
    Through,
)
from ..constraint_kinds import KINDS
from ..recipe_syntax.items import BONE, BONES, Kind, choice, flag, number, one, vector
from ..recipe_syntax.table import ABOVE_ZERO, NOT_NEGATIVE, Table
from ..recipe_syntax.toml_text import sections
from .solution import SOLUTION

BODY = Kind(
    "body",
    BodyChange,
    (number("mass", ABOVE_ZERO), number("gravity", ABOVE_ZERO)),
    named=False,
)
LOAD = Kind(
    "load",
    AddedMass,
    (BONE, number("mass", ABOVE_ZERO), number("share", ABOVE_ZERO), vector("offset")),
    needs=(("bone",), ("mass", "share")),
    excludes=(("mass", "share"),),
)
LIMB = Kind(
    "limb",
    LimbChange,
    (BONES, number("length", ABOVE_ZERO), number("mass", ABOVE_ZERO)),
    needs=(("bones",),),
)

CLEAR = Kind(
    "clear",
    Clear,
    (one("object", Table.word, attribute="thing"), number("by", NOT_NEGATIVE), BONES),
    needs=(("object",),),
)

SHAPE = Kind(
    "shape",
    Shape,
    (BONES, number("thickness", ABOVE_ZERO), choice("through", Through), flag("human")),
    needs=(("bones",),),
)

RECORDS: dict[str, Kind[Any]] = {kind.requests: kind.recipe for kind in KINDS.values()}
RECORDS["clears"] = CLEAR
RECORDS["shapes"] = SHAPE
BODY_RECORDS: dict[str, Kind[Any]] = {"added": LOAD, "limbs": LIMB}  # by field of BodyChange
NAMED = (*RECORDS.values(), *BODY_RECORDS.values())
REQUEST_KEYS = (*(kind.header for kind in NAMED), BODY.header, SOLUTION.header)


def read_requests(top: Table) -> Requests:
    """Read the requests of a recipe. top: its outermost table. Raises BadRecipe."""
    body = BODY.read(top)
    records = {field: kind.read_all(top) for field, kind in RECORDS.items()}
    parts = {field: kind.read_all(top) for field, kind in BODY_RECORDS.items()}
    body = BodyChange(body.mass, body.gravity, **parts)
    return Requests(**records, body=body, solution=SOLUTION.read(top))


def point_texts(points: Collection[PointRequest]) -> list[str]:
    """The tables of points, such as those that are offered."""
    return RECORDS["points"].text([*points])


def request_texts(requests: Requests) -> list[str]:
    """TOML tables that `read_requests` reads as these requests."""
    texts = sections(BODY.header, BODY.write(requests.body))
    texts += sections(SOLUTION.header, SOLUTION.write(requests.solution))
    for field, kind in RECORDS.items():
        texts += kind.text(getattr(requests, field))
    for field, kind in BODY_RECORDS.items():
        texts += kind.text(getattr(requests.body, field))
    return texts

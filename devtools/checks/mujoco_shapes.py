"""How deep solid shapes are in each other by MuJoCo's distances, at poses read from an armature.

Every body is one of MuJoCo's mocap bodies, so its pose is what was written, no kinematics of ours.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as ET

import mujoco
import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.solid.shapes import Capsule
from .mjcf import quaternions

POINT = 1e-7  # m, radius of a ball that is a point, and half the length of a capsule that is a ball
NEAR = 1e-3  # m; what is further apart is not looked at closer
FLAT = 1e-6  # m, by which a corner may be outside of a face's plane
SKIN = 0.1  # m, of a mesh that is not convex: each face as a slab that is so thick
FLOOR = "floor"


@dataclass(frozen=True, eq=False)
class Poses:
    """turns (T, B, 3, 3) and places (T, B, 3) m of bodies, to the world."""

    turns: FloatArray
    places: FloatArray


@dataclass(frozen=True, eq=False)
class ShapeModel:
    """Capsules on their bodies, convex solids on bodies of their own, and a level floor.

    The bodies are those of the capsules, then one for each convex solid.
    """

    model: mujoco.MjModel

    @staticmethod
    def of(
        capsules: Sequence[Capsule], bodies: int, solids: Sequence[FloatArray] = ()
    ) -> "ShapeModel":
        """solids: the corners (N, 3) m of each, in its own axes; its hull is what is solid."""
        root = ET.Element("mujoco", model="shapes")
        assets, world = ET.SubElement(root, "asset"), ET.SubElement(root, "worldbody")
        ET.SubElement(world, "geom", name=FLOOR, type="plane", size="0 0 1")
        elements = [
            ET.SubElement(world, "body", name=f"body {b}", mocap="true")
            for b in range(bodies + len(solids))
        ]
        for number, capsule in enumerate(capsules):
            _add(elements[capsule.body], f"capsule {number}", capsule)
        for number, corners in enumerate(solids):
            name = f"solid {number}"
            ET.SubElement(assets, "mesh", name=name, vertex=_text(corners))
            ET.SubElement(elements[bodies + number], "geom", name=name, type="mesh", mesh=name)
        return ShapeModel(mujoco.MjModel.from_xml_string(ET.tostring(root, encoding="unicode")))

    def depths(self, poses: Poses, pairs: Sequence[tuple[str, str]]) -> FloatArray:
        """(T, P) m that the geoms of each pair of names are in each other; 0 where they are not."""
        return np.maximum(-self.distances(poses, pairs, NEAR), 0.0)

    def distances(self, poses: Poses, pairs: Sequence[tuple[str, str]], most: float) -> FloatArray:
        """(T, P) m between the geoms of each pair of names, at most `most`; negative inside."""
        ids = [(self._id(one), self._id(other)) for one, other in pairs]
        data, found = mujoco.MjData(self.model), np.zeros((len(poses.turns), len(pairs)))
        ends = np.zeros(6)
        for t, (turns, places) in enumerate(zip(poses.turns, poses.places, strict=True)):
            data.mocap_pos[:], data.mocap_quat[:] = places, quaternions(turns)
            mujoco.mj_kinematics(self.model, data)
            for p, (one, other) in enumerate(ids):
                found[t, p] = mujoco.mj_geomDistance(self.model, data, one, other, most, ends)
        return found

    def _id(self, name: str) -> int:
        return int(self.model.geom(name).id)


def capsule_depths(capsules: Sequence[Capsule], pairs: IntArray, poses: Poses) -> FloatArray:
    """(T, P) m of the pairs (P, 2) of capsules in each other."""
    model = ShapeModel.of(capsules, poses.places.shape[1])
    return model.depths(poses, [(f"capsule {i}", f"capsule {j}") for i, j in pairs])


def floor_depths(balls: Sequence[Capsule], heights: FloatArray, poses: Poses) -> FloatArray:
    """(T, C) m of capsules (balls) below a level floor at heights (T,) m."""
    model = ShapeModel.of(balls, poses.places.shape[1])
    above = poses.places - heights[:, None, None] * np.array([0.0, 0.0, 1.0])
    names = [(f"capsule {number}", FLOOR) for number in range(len(balls))]
    return model.depths(Poses(poses.turns, above), names)


def _add(body: ET.Element, name: str, capsule: Capsule) -> None:
    along, middle = capsule.end - capsule.start, 0.5 * (capsule.start + capsule.end)
    size = repr(max(capsule.radius, POINT))
    if np.linalg.norm(along) < POINT:
        ET.SubElement(body, "geom", name=name, type="sphere", pos=_text(middle), size=size)
        return
    ends = _text(np.concatenate([capsule.start, capsule.end]))
    ET.SubElement(body, "geom", name=name, type="capsule", fromto=ends, size=size)


def _text(numbers: FloatArray) -> str:
    return " ".join(repr(float(x)) for x in numbers.ravel())


def convex_pieces(vertices: FloatArray, triangles: IntArray) -> list[FloatArray]:
    """Corners (N, 3) m of convex solids that a mesh (V, 3) m, (F, 3), is made of.

    A part that hangs together and is convex is one; of another, each face is a slab below it, which
    tells depths up to SKIN.
    """
    corners = vertices[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    corners, normals = corners[size > 0.0], across[size > 0.0] / size[size > 0.0, None]
    pieces: list[FloatArray] = []
    for part in _parts(corners):
        points = np.unique(corners[part].reshape(-1, 3), axis=0)
        above = np.einsum("fi,fpi->fp", normals[part], points - corners[part][:, :1])
        if above.max() < FLAT and above.min() < -FLAT:
            pieces.append(points)
        else:
            below = corners[part] - SKIN * normals[part][:, None]
            pieces += list(np.concatenate([corners[part], below], axis=1))
    return pieces


def _parts(corners: FloatArray) -> list[IntArray]:
    """Indices of the triangles (F, 3, 3) m of each part that hangs together."""
    _, names = np.unique(np.round(corners.reshape(-1, 3) / FLAT), axis=0, return_inverse=True)
    faces = names.reshape(-1, 3)
    label = np.arange(faces.max() + 1)
    while True:
        least = label[faces].min(axis=1)
        new = label.copy()
        np.minimum.at(new, faces.ravel(), np.repeat(least, 3))
        if np.array_equal(new, label):
            break
        label = new
    mine = label[faces[:, 0]]
    return [np.flatnonzero(mine == each) for each in np.unique(mine)]

"""The whole picture, for as long as its content stays; of a new one, the layers that stay."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Generic, TypeVar

import numpy as np
from mathutils import Vector

from .context.cache import Cache
from .context.layer import Layer
from .geometry.shapes import Label, Shape, merged, placed

T = TypeVar("T")


@dataclass(frozen=True)
class Picture(Generic[T]):
    """drawn: the shapes, as `upload` made them. labels: in the world."""

    drawn: T
    labels: tuple[Label, ...]


@dataclass(frozen=True)
class _Built:
    """A layer, in its own space."""

    shapes: tuple[Shape, ...]
    labels: tuple[Label, ...]

    @staticmethod
    def of(layer: Layer) -> _Built:
        parts = list(layer.build())
        shapes = merged(part for part in parts if isinstance(part, Shape))
        return _Built(shapes, tuple(part for part in parts if isinstance(part, Label)))


class Pictures(Generic[T]):
    """upload: makes of shapes in the world what can be drawn; called only for what is new."""

    def __init__(self, upload: Callable[[Sequence[Shape]], T]) -> None:
        self._upload = upload
        self._layers: Cache[_Built] = Cache()
        self._pictures: Cache[Picture[T]] = Cache()

    def of(self, layers: Sequence[Layer]) -> Picture[T]:
        """Layers in one picture: few and large things are drawn sooner than many small ones."""
        content = tuple((layer.part, layer.content, layer.matrix) for layer in layers)
        return self._pictures.get("picture", content, lambda: self._picture(layers))

    def clear(self) -> None:
        self._layers.clear()
        self._pictures.clear()

    def _picture(self, layers: Sequence[Layer]) -> Picture[T]:
        shapes, labels = [], []
        for layer in layers:
            built = self._layers.get(layer.part, layer.content, partial(_Built.of, layer))
            matrix = np.array(layer.matrix.copy())  # numpy cannot look into frozen ones
            shapes += [placed(shape, matrix[:3, :3], matrix[:3, 3]) for shape in built.shapes]
            labels += [
                replace(label, place=tuple(layer.matrix @ Vector(label.place)))
                for label in built.labels
            ]
        return Picture(self._upload(merged(shapes)), tuple(labels))

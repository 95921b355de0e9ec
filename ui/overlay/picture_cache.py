"""A cache of the whole picture by its content, and of its layers by theirs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Generic, TypeVar

import numpy as np
from mathutils import Vector

from ..drawing.cache import ContentCache
from .context.layer import Layer, xyz
from .geometry.shapes import Label, Shape, merged, placed

T = TypeVar("T")


@dataclass(frozen=True)
class OverlayPicture(Generic[T]):
    """batches: the shapes, as `upload` made them. labels: in the world."""

    batches: T
    labels: tuple[Label, ...]


@dataclass(frozen=True)
class BuiltLayer:
    """A layer's shapes and labels, in its own space."""

    shapes: tuple[Shape, ...]
    labels: tuple[Label, ...]

    @staticmethod
    def of(layer: Layer) -> BuiltLayer:
        parts = list(layer.build())
        shapes = merged(part for part in parts if isinstance(part, Shape))
        return BuiltLayer(shapes, tuple(part for part in parts if isinstance(part, Label)))


class PictureCache(Generic[T]):
    """upload: makes of shapes in the world what can be drawn; called only for what is new."""

    def __init__(self, upload: Callable[[Sequence[Shape]], T]) -> None:
        self._upload = upload
        self._layers: ContentCache[BuiltLayer] = ContentCache()
        self._pictures: ContentCache[OverlayPicture[T]] = ContentCache()

    def of(self, layers: Sequence[Layer]) -> OverlayPicture[T]:
        """Layers in one picture: few and large things are drawn sooner than many small ones."""
        content = tuple((layer.part, layer.content, layer.matrix) for layer in layers)
        return self._pictures.get("picture", content, lambda: self._picture(layers))

    def clear(self) -> None:
        self._layers.clear()
        self._pictures.clear()

    def _picture(self, layers: Sequence[Layer]) -> OverlayPicture[T]:
        shapes, labels = [], []
        for layer in layers:
            built = self._layers.get(layer.part, layer.content, partial(BuiltLayer.of, layer))
            matrix = np.array(layer.matrix.copy())  # numpy cannot look into frozen ones
            shapes += [placed(shape, matrix[:3, :3], matrix[:3, 3]) for shape in built.shapes]
            labels += [
                replace(label, place=xyz(layer.matrix @ Vector(label.place)))
                for label in built.labels
            ]
        return OverlayPicture(self._upload(merged(shapes)), tuple(labels))

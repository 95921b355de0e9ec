"""A cache of the whole picture by all that it depends on and by its content, and of its layers."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Generic, TypeVar

import numpy as np
from mathutils import Vector

from ..drawing.cache import ContentCache
from .context.layer import IDENTITY, Layer, xyz
from .geometry.shapes import Label, Shape, merged, placed

T = TypeVar("T")


BuiltLayer = tuple[tuple[Shape, ...], tuple[Label, ...]]
Picture = tuple[T, tuple[Label, ...]]  # the shapes as uploaded, and the labels in the world


def build(layer: Layer) -> BuiltLayer:
    """A layer's shapes, one for each look, and its labels, in its own space."""
    parts = list(layer.build())
    shapes = merged(part for part in parts if isinstance(part, Shape))
    return shapes, tuple(part for part in parts if isinstance(part, Label))


class PictureCache(Generic[T]):
    """upload: makes of shapes in the world what can be drawn; called only for what is new."""

    def __init__(self, upload: Callable[[Sequence[Shape]], T]) -> None:
        self._upload = upload
        self._layers: ContentCache[BuiltLayer] = ContentCache()
        self._pictures: ContentCache[Picture[T]] = ContentCache()

    def of(self, state: object, layers: Callable[[], Iterable[Layer]]) -> Picture[T]:
        """Layers in one picture. state: equal where the layers would be, which are then not asked
        for.

        Few and large things are drawn sooner than many small ones.
        """
        return self._pictures.get("state", state, lambda: self._of_layers(tuple(layers())))

    def _of_layers(self, layers: Sequence[Layer]) -> Picture[T]:
        content = tuple((layer.part, layer.content, layer.matrix) for layer in layers)
        return self._pictures.get("layers", content, lambda: self._picture(layers))

    def clear(self) -> None:
        self._layers.clear()
        self._pictures.clear()

    def _picture(self, layers: Sequence[Layer]) -> Picture[T]:
        shapes, labels = list[Shape](), list[Label]()
        for layer in layers:
            made, named = self._layers.get(layer.part, layer.content, partial(build, layer))
            if layer.matrix != IDENTITY:
                matrix = np.array(layer.matrix.copy(), float)  # numpy cannot look into frozen ones
                made = tuple(placed(shape, matrix[:3, :3], matrix[:3, 3]) for shape in made)
            shapes += made
            labels += [replace(n, place=xyz(layer.matrix @ Vector(n.place))) for n in named]
        return self._upload(merged(shapes)), tuple(labels)

"""Layers as they were built, for as long as their content stays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from .cache import Cache
from .layer import Layer
from .shapes import Label, Shape

T = TypeVar("T")


@dataclass(frozen=True)
class Built(Generic[T]):
    """drawn: the shapes, as `upload` made them."""

    drawn: T
    labels: tuple[Label, ...]


class Pictures(Generic[T]):
    """upload: makes of shapes what can be drawn; called only for content that is new."""

    def __init__(self, upload: Callable[[Sequence[Shape]], T]) -> None:
        self._upload = upload
        self._cache: Cache[Built[T]] = Cache()

    def of(self, layer: Layer) -> Built[T]:
        return self._cache.get(layer.part, layer.content, lambda: self._build(layer))

    def clear(self) -> None:
        self._cache.clear()

    def _build(self, layer: Layer) -> Built[T]:
        built = list(layer.build())
        shapes = [each for each in built if isinstance(each, Shape)]
        labels = tuple(each for each in built if isinstance(each, Label))
        return Built(self._upload(shapes), labels)

"""A memory of the last fits, which those who adapt again and again start from."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable

from ..fitting.fit import Fit
from .pipeline import FITTING
from .stage_clock import StageClock


class RecentFits:
    """The last few fits, by what they are of. most: how many are kept."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._fits: OrderedDict[Hashable, Fit] = OrderedDict()

    def of(self, key: Hashable, clock: StageClock, solved: Callable[[], Fit]) -> Fit:
        """The fit that is remembered, or a new one, which then is. Raises as `solved` does."""
        found = self._fits.pop(key, None)
        if found is None:
            found = solved()
        else:
            with clock.stage(FITTING):
                pass  # it takes no time
        self._fits[key] = found
        while len(self._fits) > self._most:
            self._fits.popitem(last=False)
        return found

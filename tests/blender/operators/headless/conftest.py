"""What the tests of jobs share: the clip, fits that are made once, a small picture."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from hangtime.tests.helpers.kept_fits import KeptFits


@pytest.fixture(scope="session")
def clip() -> Path:
    from hangtime.tests.helpers.clips import JUMP, mocap_path

    return mocap_path(JUMP)


@pytest.fixture(scope="session")
def kept_fits() -> KeptFits:
    from hangtime.tests.helpers.kept_fits import KeptFits

    return KeptFits()


@pytest.fixture(autouse=True, scope="module")
def _quick_jobs(_enabled: None, kept_fits: KeptFits) -> Iterator[None]:
    """A picture as large as the artist's takes half a minute on a slow machine, a fit seconds:
    what is to be fitted is fitted by the first job that needs it, and remembered."""
    from hangtime.bridge.picture.render import draw_sheet
    from hangtime.operators.headless import commands, picture
    from hangtime.solver.worker import service
    from hangtime.solver.worker.pipeline import solve

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(picture, "draw_sheet", lambda *a: draw_sheet(*a, width=160))
        patch.setattr(commands, "solve", lambda *a: solve(*a, kept_fits))
        patch.setattr(service, "fit_subject", kept_fits)
        yield

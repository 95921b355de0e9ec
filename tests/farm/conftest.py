"""These tests run by `dev.py farm --tests`, where the engines of farms are and Blender is not."""

from importlib.util import find_spec
from pathlib import Path

import pytest

if find_spec("distributed") is None:
    collect_ignore_glob = ["test_*.py"]


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for PYTHONPATH with the package as the wheel has it."""
    from hangtime.devtools.farm.installed import unpacked_wheel

    return unpacked_wheel(tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="session")
def solved(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Contents of twelve hops that were solved here, one after the other."""
    from hangtime.batch.cells.cell import run_cell
    from hangtime.batch.cells.fits import SharedFits
    from hangtime.devtools.farm.plans import contents, plan_hops

    folder = tmp_path_factory.mktemp("solved") / "batch"
    manifest = plan_hops(folder, 12)
    fits = SharedFits(folder)
    for plan in manifest.cells:
        run_cell(folder, plan.cell, fits)
    return contents(folder, manifest)

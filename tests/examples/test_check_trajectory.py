"""The shipped check of trajectory.npz: it passes a sound file, and says what is wrong in others."""

import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hangtime.solver.data.traces import UNSEEN_SUPPORT
from hangtime.solver.results.npz_export import sample
from hangtime.tests.helpers.fitted_hop import fitted_hop

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "check_trajectory.py"
Arrays = dict[str, np.ndarray]


@cache
def hop() -> Arrays:
    """A real hop's trajectory."""
    return sample(fitted_hop().motion)


def sound() -> Arrays:
    """The hop, its contacts' places where the points are: whatever else is off was put there."""
    t = {key: value.copy() for key, value in hop().items()}
    held = np.isfinite(t["contact_place"])
    t["contact_place"][held] = t["contact_point"][held]
    return t


def checked(t: Arrays, folder: Path) -> tuple[int, str]:
    """Exit code and table."""
    np.savez(folder / "trajectory.npz", **t)
    command = [sys.executable, str(SCRIPT), str(folder / "trajectory.npz")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.stderr == ""
    return done.returncode, done.stdout


def missed(table: str) -> set[str]:
    """Names of the lines whose limits are broken."""
    return {line[:34].strip() for line in table.splitlines() if line.endswith("NO")}


def told(table: str, name: str) -> str:
    """The rest of a line."""
    (line,) = (each for each in table.splitlines() if each.startswith(name))
    return line[34:]


def test_a_sound_trajectory_passes(tmp_path: Path) -> None:
    code, table = checked(sound(), tmp_path)
    assert missed(table) == set()
    assert code == 0
    assert len(table.splitlines()) == 9


def test_a_result_s_physics_hold_and_its_feet_are_measured(tmp_path: Path) -> None:
    code, table = checked(hop(), tmp_path)
    assert all(name.startswith("loaded point") for name in missed(table))
    assert code == (1 if missed(table) else 0)


def heavier(t: Arrays) -> None:
    t["mass"] *= 1.4


def pushed(t: Arrays) -> None:
    t["contact_force"][..., 2] *= 1.4


def bulging(t: Arrays) -> None:
    """The heaviest body is 5 mm off for an eighth of a second."""
    bump = 0.005 * np.sin(np.linspace(0.0, np.pi, 125)) ** 4
    t["com"][300:425, t["mass"].argmax(), 0] += bump


def spinning(t: Arrays) -> None:
    """Bodies turn otherwise than moments make them."""
    t["inertia"] *= 3.0


def sideways(t: Arrays) -> None:
    t["contact_friction"][:] = 0.05


def floating(t: Arrays) -> None:
    t["contact_force"][len(t["time"]) // 2] += 10.0  # in flight


def sliding(t: Arrays) -> None:
    t["contact_place"][..., 0] += 0.02


def sunk(t: Arrays) -> None:
    t["contact_place"][..., 2] += 0.02


def lifted(t: Arrays) -> None:
    t["contact_place"][..., 2] -= 0.02


@pytest.mark.parametrize(
    ("spoil", "line"),
    [
        (heavier, "residual force, rms"),
        (pushed, "residual force, rms"),
        (bulging, "residual force, peak"),
        (spinning, "residual moment, peak"),
        (sideways, "force outside its friction cone"),
        (floating, "force on what does not touch"),
        (sliding, "loaded point slides"),
        (sunk, "loaded point under its surface"),
        (lifted, "loaded point above its surface"),
    ],
)
def test_a_spoilt_trajectory_fails(
    spoil: Callable[[Arrays], None], line: str, tmp_path: Path
) -> None:
    t = sound()
    spoil(t)
    code, table = checked(t, tmp_path)
    assert line in missed(table)
    assert code == 1


def test_unseen_support_is_told_and_breaks_no_limit(tmp_path: Path) -> None:
    """Half of each force is of something unseen, which pushes at the same points."""
    t = sound()
    shares, without = (
        t["contact_force"] / 2,
        ("contact_place", "contact_normal", "contact_friction"),
    )
    peak = np.linalg.norm(shares.sum(axis=1), axis=1).max() / (9.81 * t["mass"].sum())
    unseen = {key: np.full_like(t[key], np.nan) for key in without}
    unseen |= {"contact_point": t["contact_point"], "contact_force": shares}
    unseen |= {"contact_slides": np.zeros_like(t["contact_slides"])}
    t["contact_force"] = shares
    t |= {key: np.concatenate([t[key], more], axis=1) for key, more in unseen.items()}
    t["contact_names"] = np.array(
        [*t["contact_names"], *len(t["contact_names"]) * [UNSEEN_SUPPORT]]
    )
    code, table = checked(t, tmp_path)
    assert (code, missed(table)) == (0, set())
    assert float(told(table, "unseen support, peak").split()[0]) == pytest.approx(peak, rel=0.01)
    t["contact_names"][:] = "Left toe"
    assert missed(checked(t, tmp_path)[1]) == {"force on what does not touch"}

"""Checks a motion by its trajectory.npz alone: python check_trajectory.py trajectory.npz

Needs numpy and nothing of Hangtime. Newton's and Euler's equations of the whole body by finite
differences, friction, and how far loaded contact points are from their places. SI units, Z up.
Prints a table; ends with 1 where a limit is broken. What something unseen carries, which the file
tells, is a force like others, without a limit. The keys: solver/results/npz_export.py.
"""

import sys

import numpy as np

STANDARD_GRAVITY = 9.81  # m/s²; a body weight is the mass times this, on the Moon too
LOADED = 0.05  # body weights; a point with less may slip
UNSEEN = "Unseen support"  # the contact_names of forces of what the recording does not show


def derivatives(x, step):
    """First and second derivative by five points, fourth order; the first and last two are lost."""
    a, b, c, d, e = (x[k : len(x) - 4 + k] for k in range(5))
    second = (-a + 16 * b - 30 * c + 16 * d - e) / (12 * step**2)
    return (a - 8 * b + 8 * d - e) / (12 * step), second


def axial(m):
    """The vectors (..., 3) of the skew parts of matrices (..., 3, 3)."""
    skew = 0.5 * (m - np.swapaxes(m, -1, -2))
    return np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)


def residuals(t):
    """Force (N) and moment (N·m, about the centre of mass) that nothing explains, by instant.

    Instants whose differences reach across the begin or end of a contact's force are left out:
    accelerations jump there.
    """
    step, inner, mass = t["time"][1] - t["time"][0], slice(2, -2), t["mass"]
    acceleration = derivatives(t["com"], step)[1]
    back = np.swapaxes(t["rotation"], -1, -2)[inner]
    # R' R^T = [omega] and R'' R^T = [alpha] + [omega][omega], the last of which is symmetric.
    omega, alpha = (axial(each @ back) for each in derivatives(t["rotation"], step))
    inertia = t["rotation"][inner] @ t["inertia"] @ back
    spin = np.einsum("tbij,tbj->tbi", inertia, omega)
    turning = np.einsum("tbij,tbj->tbi", inertia, alpha) + np.cross(omega, spin)
    centre = np.einsum("b,tbi->ti", mass / mass.sum(), t["com"])[inner, None]
    push, at = t["contact_force"][inner], t["contact_point"][inner] - centre
    force = np.einsum("b,tbi->ti", mass, acceleration - t["gravity"]) - push.sum(axis=1)
    moment = np.cross(t["com"][inner] - centre, mass[:, None] * acceleration) + turning
    moment = moment.sum(axis=1) - np.cross(at, push).sum(axis=1)
    touch = np.abs(t["contact_force"]).max(axis=2) > 0.0
    near = np.stack([touch[k : len(touch) - 4 + k] for k in range(5)])
    clear = (near == near[2]).all(axis=(0, 2))
    return np.linalg.norm(force[clear], axis=1), np.linalg.norm(moment[clear], axis=1)


def in_weights(t):
    """Contact forces (T, C, 3) in body weights."""
    return t["contact_force"] / (STANDARD_GRAVITY * t["mass"].sum())


def unseen_support(t):
    """Largest force of what the recording does not show, body weights; None where there is none."""
    pushes = in_weights(t)[:, t["contact_names"] == UNSEEN]
    return np.linalg.norm(pushes.sum(axis=1), axis=1).max() if pushes.size else None


def lines(t):
    """Name, value, limit and unit of every line of the table."""
    force, moment = residuals(t)
    largest = np.linalg.norm(t["contact_force"].sum(axis=1), axis=1).max()
    low = np.nanmin(t["contact_place"][..., 2])
    height = np.einsum("b,tb->t", t["mass"] / t["mass"].sum(), t["com"][..., 2]).mean() - low
    for name, values, unit, limit in (
        ("residual force", force, largest, 5.0),
        ("residual moment", moment, largest * height, 1.0),
    ):
        yield f"{name}, rms", 100.0 * np.sqrt((values**2).mean()) / unit, limit, "%"
        yield f"{name}, peak", 100.0 * values.max() / unit, limit, "%"
    pushes = in_weights(t)
    held, normal = np.isfinite(t["contact_normal"]).all(axis=-1), t["contact_normal"]
    pressed = (pushes * normal).sum(axis=-1)
    along = np.linalg.norm(pushes - pressed[..., None] * normal, axis=-1)
    friction = t["contact_friction"]
    coned = held & np.isfinite(friction)  # a grip has no cone
    beyond = along[coned] - friction[coned] * pressed[coned]
    yield "force outside its friction cone", beyond.max(initial=0.0), 0.01, "BW"
    off_touch = pushes[~held & (t["contact_names"] != UNSEEN)]
    yield "force on what does not touch", np.abs(off_touch).max(initial=0.0), 1e-6, "BW"
    off = t["contact_point"] - t["contact_place"]
    above = (off * normal).sum(axis=-1)
    slid = np.linalg.norm(off - above[..., None] * normal, axis=-1)
    loaded = held & (np.linalg.norm(pushes, axis=-1) > LOADED)
    slide = slid[loaded & ~t["contact_slides"]].max(initial=0.0)
    yield "loaded point slides", 1000.0 * slide, 5.0, "mm"
    under = np.maximum(-above[loaded], 0.0).max(initial=0.0)
    yield "loaded point under its surface", 1000.0 * under, 5.0, "mm"
    yield "loaded point above its surface", 1000.0 * above[loaded].max(initial=0.0), 10.0, "mm"


def main(path):
    with np.load(path) as file:
        t = dict(file)
    table, unseen = list(lines(t)), unseen_support(t)
    for name, value, limit, unit in table:
        holds = "yes" if value <= limit else "NO"
        print(f"{name:<34}{value:10.3g} {unit:<4}at most {limit:g} {unit:<4} {holds}")
    if unseen is not None:
        print(f"{'unseen support, peak':<34}{unseen:10.3g} BW   without a limit")
    return 0 if all(value <= limit for _, value, limit, _ in table) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)

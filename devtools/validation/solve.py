"""The process of one trial: reads, fits, compares; leaves DIR/NAME.pickle and its curves."""

from pathlib import Path

from ...operators.words.messages import sentence
from ...solver.data.faults import Fault
from ..processes import dump
from .contacts import events, friction, pressure
from .curves import picture
from .fitted import FittedTrial, fit_trial, ground_forces
from .forces import (
    foot_errors,
    largest_step,
    measured_flights,
    rms_errors,
    stances,
    total_variation,
)
from .motions import closeness, hand_jerk, hold, peak_torques
from .result import Measured, TrialResult
from .trials import GroundForces, read


def main(argv: list[str]) -> int:
    folder, name, out = Path(argv[0]), argv[1], Path(argv[2])
    trial = read(folder, name)
    result = TrialResult(name, trial.kind)
    try:
        fitted = fit_trial(trial)
    except Fault as fault:
        result = TrialResult(name, result.kind, refused=sentence(fault))
    else:
        ours = ground_forces(fitted)
        result = TrialResult(name, result.kind, measured=measured(fitted, ours))
        if "--no-curves" not in argv:
            (out / f"{name}.svg").write_text(picture(trial, ours), encoding="utf-8")
    dump(result, out / f"{name}.pickle")
    return 0


def measured(fitted: FittedTrial, ours: GroundForces) -> Measured:
    """Everything that is told of a trial."""
    trial, motion = fitted.trial, fitted.fit.motion
    sides = ((ours, fitted.flights), (trial.plates, measured_flights(trial)))
    steps = [
        largest_step(forces, trial.compared, [t for flight in flights for t in flight])
        for forces, flights in sides
    ]
    mine, theirs = (total_variation(forces, trial.compared) for forces, _ in sides)
    return Measured(
        seconds=fitted.seconds,
        compared=trial.compared,
        errors=tuple(rms_errors(trial, ours)),
        foot_errors=foot_errors(trial, ours),
        total_variation=(mine, theirs),
        steps=(steps[0], steps[1]),
        stances=tuple(stances(trial, ours)),
        events=tuple(events(trial, ours, fitted.contacts)),
        pressure=pressure(trial, ours),
        friction=(friction(trial, ours), friction(trial, trial.plates)),
        closeness=closeness(fitted.fit),
        hand_jerk=hand_jerk(fitted.fit),
        hold=hold(motion),
        torques_per_kg=peak_torques(motion),
    )

"""The process of one clip: reads, fits, compares; leaves DIR/NAME.pickle and a trial's curves."""

from pathlib import Path

from ...operators.words.messages import sentence
from ...solver.data.faults import Fault
from ..processes import dump
from .causes.vary import vary
from .contacts import events, friction, pressure
from .curves import picture
from .fitted import FittedTrial, fit_trial, ground_forces, told_forces
from .forces import (
    PEAK_CUT_OFF,
    foot_errors,
    largest_step,
    measured_flights,
    rms_errors,
    stances,
    total_variation,
)
from .motions import motion_measures
from .recorded import RECORDINGS, fit_recording
from .result import Measured, SmoothedError, TrialResult
from .trials import GroundForces, Trial, read

WIDTHS = (0.012, 0.015, 0.018, 0.021, 0.025, 0.03)  # s, of smoothing


def main(argv: list[str]) -> int:
    """argv: folder, clip, DIR, then --curves where a picture is wanted, then NAME=VALUE."""
    folder, name, out = Path(argv[0]), argv[1], Path(argv[2])
    curves = argv[3:4] == ["--curves"]
    vary(argv[4:] if curves else argv[3:])
    try:
        if name in RECORDINGS:
            motion = motion_measures(fit_recording(RECORDINGS[name]))
            result = TrialResult(name, motion=motion)
        else:
            result = solve_trial(read(folder, name), out, curves=curves)
    except Fault as fault:
        result = TrialResult(name, refused=sentence(fault))
    dump(result, out / f"{name}.pickle")
    return 0


def solve_trial(trial: Trial, out: Path, *, curves: bool) -> TrialResult:
    """A trial's result, and its curves. Raises what `fit_trial` does."""
    fitted = fit_trial(trial)
    ours = ground_forces(fitted)
    if curves:
        (out / f"{trial.name}.svg").write_text(picture(trial, ours), encoding="utf-8")
    motion = motion_measures(fitted.fit)
    return TrialResult(trial.name, motion, measured(fitted, ours), trial.kind)


def measured(fitted: FittedTrial, ours: GroundForces) -> Measured:
    """Everything that is told of a trial's forces."""
    trial = fitted.trial
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
        smoothed=smoothed_errors(fitted),
    )


def smoothed_errors(fitted: FittedTrial) -> tuple[SmoothedError, ...]:
    """Of what the recording alone tells, by the width of smoothing."""
    errors = [rms_errors(fitted.trial, told_forces(fitted, width)) for width in WIDTHS]
    at_15 = [next(e for e in each if e.cut_off == PEAK_CUT_OFF) for each in errors]
    return tuple(SmoothedError(width, e.ours) for width, e in zip(WIDTHS, at_15, strict=True))

"""What the tables tell of each trial: a column's name and its words, and the notes."""

from collections.abc import Callable, Sequence
from statistics import mean

from .causes.landings import RecordedLanding
from .contacts import EventKind
from .forces import FORWARD, LEFT, UP, RmsError
from .motions import MotionMeasures
from .result import Measured

Column = tuple[str, Callable[[Measured], str]]


def _of_error(cut_off: float) -> tuple[Column, ...]:
    def column(name: str, of: Callable[[RmsError], str]) -> Column:
        return name, lambda m: of(m.error(cut_off))

    return (
        column("vertical", lambda e: f"{e.ours[UP]:.3f}"),
        column("plain", lambda e: f"{e.baseline[UP]:.3f}"),
        column("(its file)", lambda e: f"{e.stored[UP]:.3f}" if e.stored else "–"),
        column("ratio", lambda e: f"{e.ours[UP] / e.baseline[UP]:.2f}"),
        column("in stances", lambda e: f"{e.ours_stance[UP]:.3f}"),
        column("plain", lambda e: f"{e.baseline_stance[UP]:.3f}"),
        column("forward", lambda e: f"{e.ours[FORWARD]:.3f}"),
        column("plain", lambda e: f"{e.baseline[FORWARD]:.3f}"),
        column("sideways", lambda e: f"{e.ours[LEFT]:.3f}"),
        column("plain", lambda e: f"{e.baseline[LEFT]:.3f}"),
    )


def _late(kind: EventKind, *, by_force: bool = False) -> Callable[[Measured], str]:
    def words(m: Measured) -> str:
        late = m.late(kind, by_force=by_force)
        if not late:
            return "–"
        return f"{sum(late) / len(late):+.0f} ({max(late, key=abs):+.0f})"

    return words


def _peak(m: Measured) -> str:
    worst = max((s.peak[0] - s.peak[1] for s in m.stances), key=abs, default=None)
    return "–" if worst is None else f"{worst:+.2f}"


def _mean(words: str, of: Callable[[Measured], list[float]]) -> Callable[[Measured], str]:
    def cell(m: Measured) -> str:
        values = of(m)
        return words.format(sum(values) / len(values)) if values else "–"

    return cell


SHAPE: tuple[Column, ...] = (
    ("variation", lambda m: f"{m.total_variation[0] / m.total_variation[1]:.2f}"),
    ("step (BW)", lambda m: f"{m.steps[0].jump:.2f}"),
    ("at (s)", lambda m: f"{m.steps[0].jump_at:.3f}"),
    ("plates'", lambda m: f"{m.steps[1].jump:.2f}"),
    ("change (BW)", lambda m: f"{m.steps[0].change:.2f}"),
    ("plates'", lambda m: f"{m.steps[1].change:.2f}"),
    ("peak (BW)", _peak),
    (
        "its time (ms)",
        _mean("{:+.0f}", lambda m: [1e3 * (s.peak_time[0] - s.peak_time[1]) for s in m.stances]),
    ),
    (
        "impulse (%)",
        _mean("{:+.1f}", lambda m: [100 * (s.impulse[0] / s.impulse[1] - 1) for s in m.stances]),
    ),
    (
        "loading rate",
        _mean("{:.2f}", lambda m: [s.loading_rate[0] / s.loading_rate[1] for s in m.stances]),
    ),
    ("left foot", lambda m: f"{m.foot_errors[0][UP]:.3f}"),
    ("right", lambda m: f"{m.foot_errors[1][UP]:.3f}"),
)
CONTACTS: tuple[Column, ...] = (
    ("touch-down (ms)", _late(EventKind.TOUCH_DOWN)),
    ("lift-off (ms)", _late(EventKind.LIFT_OFF)),
    ("by force: down", _late(EventKind.TOUCH_DOWN, by_force=True)),
    ("off", _late(EventKind.LIFT_OFF, by_force=True)),
    ("not found", lambda m: f"{m.not_found} of {len(m.events)}"),
    ("pressure (cm)", lambda m: f"{m.pressure.distance_cm:.1f}" if m.pressure else "–"),
    ("forward (cm)", lambda m: f"{m.pressure.forward_cm:+.1f}" if m.pressure else "–"),
    ("friction 95 %", lambda m: f"{m.friction[0].largest_95:.2f}"),
    ("most", lambda m: f"{m.friction[0].largest:.2f}"),
    ("plates' 95 %", lambda m: f"{m.friction[1].largest_95:.2f}"),
    ("most", lambda m: f"{m.friction[1].largest:.2f}"),
)
MOTION: tuple[tuple[str, Callable[[MotionMeasures], str]], ...] = (
    ("centres (cm)", lambda m: f"{m.closeness.whole_cm:.2f}"),
    ("first ten", lambda m: f"{m.closeness.first_cm:.2f}"),
    ("last ten", lambda m: f"{m.closeness.last_cm:.2f}"),
    ("hands' jerk", lambda m: f"{m.hand_jerk.ratio:.2f}" if m.hand_jerk else "–"),
    ("slide (mm)", lambda m: f"{m.hold.slide_mm:.1f}"),
    ("under", lambda m: f"{m.hold.under_mm:.1f}"),
    ("above", lambda m: f"{m.hold.above_mm:.1f}"),
    ("hip (N·m/kg)", lambda m: f"{m.torques_per_kg.hip:.1f}"),
    ("knee", lambda m: f"{m.torques_per_kg.knee:.1f}"),
    ("ankle", lambda m: f"{m.torques_per_kg.ankle:.1f}"),
    ("landing knee", lambda m: f"{m.landing_knee:.1f}" if m.landing_knee else "–"),
)


def _most(of: Callable[[RecordedLanding], float]) -> Callable[[MotionMeasures], str]:
    """Mean and largest over the landings, in cm."""

    def cell(m: MotionMeasures) -> str:
        values = [100.0 * of(landing) for landing in m.recorded_landings]
        return f"{mean(values):.1f} ({max(values):.1f})" if values else "–"

    return cell


LANDINGS: tuple[tuple[str, Callable[[MotionMeasures], str]], ...] = (
    ("landings", lambda m: f"{len(m.recorded_landings)}"),
    ("height (cm)", _most(lambda landing: landing.height)),
    ("leg too short by (cm)", _most(lambda landing: landing.short)),
    (
        "speed (m/s)",
        lambda m: (
            f"{mean(x.speed for x in m.recorded_landings):.2f}" if m.recorded_landings else "–"
        ),
    ),
)


def smoothing(measured: Sequence[Measured]) -> tuple[tuple[str, ...], ...]:
    """A row for each width: mean errors over the trials, vertical, forward, sideways."""
    rows = []
    for same in zip(*(m.smoothed for m in measured), strict=True):
        errors = (mean(each.error[axis] for each in same) for axis in (UP, FORWARD, LEFT))
        rows.append((f"{1e3 * same[0].width:.0f} ms", *(f"{error:.3f}" for error in errors)))
    return tuple(rows)


ERRORS = """Summed contact force, rms error in body weights. *plain* is the recording's centre
of mass differentiated twice, *(its file)* what the trial's own file has of that. *in stances*
leaves out the flights, where ours is zero by construction."""
SHAPES = """*variation*: total variation of the vertical force over the plates'. *step*: the
largest change within 2 ms beyond what the slopes of the 2 ms before and after explain, where
the whole body neither lands nor leaves; *change*: the same without taking the slopes off.
Plates at 100 Hz cannot tell either. *peak*: the worst stance's, ours minus the plates'; *its
time*, *impulse* and *loading rate* (largest slope, ours over the plates'): means over the
stances; all at 15 Hz but the impulse. *left foot*, *right*: rms error of each one's vertical
force at 15 Hz, BW."""
CONTACT_WORDS = """How much later than the plates', mean (worst): of the contacts that were
found, and of when the fit's force passes 20 N. *not found*: no contact of ours, or one that the
clip's end cuts off. *pressure*: distance of the centres of pressure of a foot, mean weighted by
force. *friction*: tangential over vertical force of a foot that carries 0.1 BW or more, 95th
percentile and maximum."""
MOTIONS = """Joint centres of the fit against the recording, rms; jerk of the wrists within 0.1
s of landings, fit over recording; worst of any point while it carries more than 5 % of the
weight, against the place that its contact has, first and last instant included; peak torques, the
knee's also within 0.3 s after the body's landings. Below the trials: recordings without plates."""
LANDED = """Feet as they were recorded when their contact begins, means (most). *height*: of
the point that lands first above the place where it then stands. *leg too short*: by how much the
straight leg does not reach that place from the recorded hip, with a sole's give taken off; negative
where it does. *speed*: of the point, downwards."""
SMOOTHED = """What the fit is told of the centre of mass's acceleration, before it fits: a local
regression of the recording, by the width of its weights. Rms error of the load that it tells, BW,
at 15 Hz, mean over the trials but walks. The fit takes 18 ms for the vertical part and 30 ms for
the level ones (`SMOOTHING_TIME`, `LEVEL_SMOOTHING_TIME`)."""
TABLES = (
    ("Forces at 15 Hz", ERRORS, _of_error(15.0)),
    ("Forces at 10 Hz", "", _of_error(10.0)),
    ("Forces at 20 Hz", "", _of_error(20.0)),
    ("Shape of the vertical force", SHAPES, SHAPE),
    ("Contacts", CONTACT_WORDS, CONTACTS),
)

"""What is said of every solver status and violation: templates, to be translated."""

from ....solver.data.row_kinds import RowKind
from ....solver.data.status import Status

OUTCOMES = {
    Status.SOLVED: "Solved: the motion obeys physics and everything asked for holds.",
    Status.STALLED: "No motion was found that obeys physics and holds all that is asked for. "
    "Ask for less of what is named here, or check the contacts' frames.",
    Status.TOO_MANY_STEPS: "No motion was found within the allowed number of steps. "
    "Ask for less of what is named here, or check the contacts' frames.",
    Status.MISSED: "The motion obeys physics, but between the solver's instants something asked "
    "for is missed by more than is promised. Loosen what is named here a little.",
    Status.NO_BODY: "The motion obeys physics and what was asked for holds, but no body can do it: "
    "it goes through itself, the floor or an obstacle, or joints far beyond their range. Ask for "
    "less of what was asked, or elsewhere.",
    Status.STOPPED: "Stopped before everything was met; the motion is as the solver left it.",
}

ASKED = "Asked for: {}."
DAMAGED = (
    "The recording is damaged, which may be why; Examine, or the command doctor, tells more: {}"
)
MORE_DAMAGES = " And {} more."

AT_FRAME = " (frame {:.0f})"
ANGLE_MISSED = "“{name}” is missed by {amount:.3g}°"
AWAY = "“{name}” stays {amount:millimetres} from its place"
AT_ITS_END = "{name} as far as its range goes"
MISSED = {  # of a constraint, by its type
    RowKind.BALANCE: "in {name}, {amount:.3g} body weights are not carried as they must be",
    RowKind.MOMENT: "in {name}, the body would have to push off thin air ({amount:.3g} BW·m)",
    RowKind.PIN: AWAY,
    RowKind.PIN_SPEED: "“{name}” still slides at {amount:.3g} m/s",
    RowKind.POINT: AWAY,
    RowKind.BEND: ANGLE_MISSED,
    RowKind.CONE: ANGLE_MISSED,
    RowKind.TWIST: ANGLE_MISSED,
    RowKind.ORIENTATION: ANGLE_MISSED,
    RowKind.POSE: ANGLE_MISSED,
    RowKind.PUSH: "“{name}” would have to pull with {amount:.3g} body weights",
    RowKind.FRICTION: "“{name}” slips: {amount:.3g} body weights beyond its friction (Contact "
    "Force sets it)",
    RowKind.PEAK: "“{name}” is exceeded by {amount:.3g} body weights",
    RowKind.SOLID: "{name} stays in by {amount:millimetres}{frame:at}",
    RowKind.RANGE: "{name} {amount:.3g}° beyond its range{frame:at}",
    RowKind.TORQUE: "“{name}” needs {amount:.3g} N·m more than its limit",
}

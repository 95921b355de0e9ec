"""Other values of the solver's constants, for one process: what a constant is worth is measured.

dev.py validate FOLDER --vary SOLE_COMPLIANCE=0.03 acceleration_time=0.03
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from types import ModuleType

from ....solver.analysis import accelerations, grounding
from ....solver.contacts import force_timing
from ....solver.fitting import fit, transcribe
from ....solver.objectives.tracking_cost import CostWeights
from ....solver.results import certificate
from ....solver.transcription import compliant_sole

# Constants by name, with the modules that hold them; the weights of the fit's cost are known too.
HOLDERS: Mapping[str, tuple[ModuleType, ...]] = {
    "SMOOTHING_TIME": (accelerations,),
    "LEVEL_SMOOTHING_TIME": (accelerations,),
    "IMPACT_DELAY": (force_timing,),
    "SOLE_COMPLIANCE": (grounding,),
    "SINKING_TIME": (compliant_sole, certificate),
    "EDGE_SPAN": (transcribe,),
}
WEIGHTS = tuple(each.name for each in fields(CostWeights) if each.name != "goes_on")


def unknown(changes: Sequence[str]) -> str | None:
    """What is wrong with changes NAME=VALUE, as a sentence; None if nothing is."""
    for change in changes:
        name, _, value = change.partition("=")
        if name not in HOLDERS and name not in WEIGHTS:
            return f"There is no constant {name}; there are: {', '.join((*HOLDERS, *WEIGHTS))}."
        try:
            float(value)
        except ValueError:
            return f"{change} is no NAME=VALUE."
    return None


def vary(changes: Sequence[str]) -> None:
    """Changes constants of this process, each NAME=VALUE in the constant's own unit."""
    for change in changes:
        name, _, value = change.partition("=")
        if name in WEIGHTS:
            fit.FIT_COST_WEIGHTS = replace(fit.FIT_COST_WEIGHTS, **{name: float(value)})  # type: ignore[arg-type]
        for module in HOLDERS.get(name, ()):
            setattr(module, name, float(value))

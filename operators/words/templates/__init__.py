"""What is said of every fault, solver status and violation: templates, to be translated.

Those of faults have a file for each of `solver.data.faults`. A template names attributes of its
fault in braces; formats with names are those of `_Formatter` in messages.py.
"""

from ....solver.data.faults import Fault
from .changes import CHANGES
from .loops import LOOPS
from .outcomes import ASKED as ASKED
from .outcomes import AT_FRAME as AT_FRAME
from .outcomes import AT_ITS_END as AT_ITS_END
from .outcomes import DAMAGED as DAMAGED
from .outcomes import MISSED as MISSED
from .outcomes import MORE_DAMAGES as MORE_DAMAGES
from .outcomes import OUTCOMES as OUTCOMES
from .recordings import RECORDINGS
from .requests import REQUESTS
from .rigs import MORE_NAMES as MORE_NAMES
from .rigs import RIGS
from .scenes import SCENES
from .solving import PLACES as PLACES
from .solving import SOLVING

TEMPLATES: dict[type[Fault], str | tuple[str, ...]] = {
    **RECORDINGS,
    **LOOPS,
    **RIGS,
    **REQUESTS,
    **SCENES,
    **CHANGES,
    **SOLVING,
}

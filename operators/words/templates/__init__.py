"""What is said of every fault, solver status and violation: templates, to be translated.

A template names attributes of its fault in braces; formats with names are those of `_Formatter` in
messages.py.
"""

from ....solver.data.faults import Fault
from .changes import CHANGES
from .faults import FAULTS
from .faults import PLACES as PLACES
from .outcomes import ASKED as ASKED
from .outcomes import AT_FRAME as AT_FRAME
from .outcomes import AT_ITS_END as AT_ITS_END
from .outcomes import DAMAGED as DAMAGED
from .outcomes import MISSED as MISSED
from .outcomes import MORE_DAMAGES as MORE_DAMAGES
from .outcomes import OUTCOMES as OUTCOMES
from .rigs import MORE_NAMES as MORE_NAMES
from .rigs import RIGS

TEMPLATES: dict[type[Fault], str | tuple[str, ...]] = {**FAULTS, **CHANGES, **RIGS}

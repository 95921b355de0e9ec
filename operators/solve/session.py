"""Unsaved run-time state: running solve, last failure, best result."""

from dataclasses import dataclass, field
from functools import cache
from typing import Protocol

import bpy
from bpy.app.handlers import persistent

from ...bridge.armature.keys_digest import KeptDigests
from ...bridge.recipe.keys import KeyOptions
from ...bridge.recipe.loop import LoopOptions
from ...bridge.recipe.result import ResultOptions
from ...bridge.repairs.analysed_state import AnalysedState
from ...bridge.results.made import AskedSettings
from ...bridge.scene.read import SceneReading
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.unseen.offered import OfferedSupport
from ...solver.worker.protocol import Adapted
from ..status_bar import StatusBar
from ..words.failure_text import Failure
from .solving import SolveState, Solving


@dataclass(frozen=True)
class Asked:
    """A request: of which armature (its name then, and its number in this session), what its
    recording and the scene's surfaces were, what was asked, and which bones stay aimed.

    settings: those that ask for it, as the artist may change them before it is solved. result,
    keys, loop: what they say of these, for the same reason. state: what the recording is made of,
    where a result is to be written.
    """

    armature: str
    uid: int
    recording: Recording
    problem: MotionProblem
    settings: AskedSettings
    result: ResultOptions = field(default_factory=ResultOptions)
    keys: KeyOptions = field(default_factory=KeyOptions)
    loop: LoopOptions | None = None
    scene: SceneReading = field(default_factory=SceneReading)
    aimed: tuple[str, ...] = ()
    state: AnalysedState | None = None

    @property
    def window(self) -> Recording:
        """The frames of the recording that are adapted."""
        assert self.problem.frames is not None
        return self.recording.window(*self.problem.frames)


class Running(Protocol):
    """A modal operator at work."""

    def leave(self) -> None:
        """Nothing of the work remains."""


@dataclass
class Session:
    """The solve under way, who runs it, why the last one failed, what it was asked, and the best
    motion that it found; the armature (its number) whose body something unseen carries, and what
    would; of which armature, recording and bodies the controls were tried last, and pose them; what
    the last drag was about, or Analyze has prepared the next one for; frames a second and metres
    per unit of the scene that was seen last; digests of actions' keys, as long as these cannot be
    others; what the status bar says."""

    solving: Solving | None = None
    failure: Failure | None = None
    best: tuple[Asked, Adapted] | None = None
    support: tuple[int, OfferedSupport] | None = None
    tried: tuple[int, str, tuple[str, ...]] | None = None
    dragged: Asked | None = None
    units: tuple[float, float] | None = None
    digests: KeptDigests = field(default_factory=KeptDigests)
    running: list[Running] = field(default_factory=list)
    status_bar: StatusBar = field(default_factory=StatusBar)

    def best_of(self, armature: bpy.types.Object | None) -> tuple[Asked, Adapted] | None:
        """The best motion that a failed solve of an armature found."""
        best = self.best
        mine = best is not None and armature is not None and best[0].uid == armature.session_uid
        return best if mine else None

    def advance(self, to: SolveState) -> None:
        """The solve under way goes on to its next part."""
        assert self.solving is not None
        self.solving.advance(to)

    def end(self) -> None:
        """Ends what runs, without a word; for when the extension goes."""
        for operator in list(self.running):
            operator.leave()
        self.digests.forget()
        self.best = self.failure = self.support = self.tried = self.dragged = None


@persistent  # type: ignore[untyped-decorator]  # any, in the stubs
def forget_file(*_of_handlers: object) -> None:
    """Another file was loaded: nothing that is kept is of it."""
    session().end()


@cache
def session() -> Session:
    """The one session of this Blender."""
    return Session()

"""What can be wrong with a batch; each text is a sentence: what is wrong, where, what to do."""

from pathlib import Path


class BatchFault(Exception):
    """A batch that cannot be planned, begun or gone on with. exit_code: 1, as of `State.FAILED`,
    where the same command may do later; 2 where what was asked has to change."""

    exit_code = 1


class WrongPlan(BatchFault):
    """Clips, recipes, ranges or a table that make no batch."""

    exit_code = 2


class WrongManifest(BatchFault):
    """A manifest that is not there, or was edited."""

    exit_code = 2


class OtherVersion(WrongManifest):
    """A manifest of another version of Hangtime."""


class FolderTaken(BatchFault):
    """A folder in which another batch is."""

    exit_code = 2


class FolderBusy(BatchFault):
    """A folder in which a batch runs."""


class FolderGone(BatchFault):
    """A folder that cannot be read or written, or is full."""


def gone(path: Path, error: OSError) -> FolderGone:
    """The fault of a folder that cannot be used; what is in it stays."""
    return unusable(str(path), error.strerror or type(error).__name__)


def unusable(path: str, why: str) -> FolderGone:
    """The same, of a fault that was told in words."""
    return FolderGone(
        f"{path} cannot be used ({why}); make room or mend that, then give the same command again, "
        "which goes on where this ended."
    )

"""What can be wrong with a batch; each text is a sentence: what is wrong, where, what to do."""


class BatchFault(Exception):
    """A batch that cannot be planned, begun or gone on with."""


class WrongPlan(BatchFault):
    """Clips, recipes, ranges or a table that make no batch."""


class WrongManifest(BatchFault):
    """A manifest that is not there, or was edited."""


class OtherVersion(WrongManifest):
    """A manifest of another version of Hangtime."""


class FolderTaken(BatchFault):
    """A folder in which another batch is, or runs."""


class FolderGone(BatchFault):
    """A folder that cannot be read or written, or is full."""

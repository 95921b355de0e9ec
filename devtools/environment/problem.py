"""The error of a failed set-up. Standard library only."""


class SetUpError(Exception):
    """Says in one sentence what this machine lacks and what to do."""

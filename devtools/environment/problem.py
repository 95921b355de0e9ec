"""The one way in which setting up fails. Standard library only."""


class SetUpError(Exception):
    """Says in one sentence what this machine lacks and what to do."""

"""Why a command of maintenance cannot do its work."""


class CannotRun(Exception):
    """The sentence for the operator, with the remedy."""

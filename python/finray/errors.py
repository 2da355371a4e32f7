"""The exceptions of finray. Their texts are those of the command line.

>>> import finray
>>> try:
...     finray.Scene(contacts=17)
... except finray.Error as error:
...     type(error).__name__, error.exit_code, str(error)
('InputError', 2, 'scene:1:14: expected a number of contacts from 0 to 16, or auto')
"""


class Error(Exception):
    """The base of all errors of finray."""

    #: The exit code of an executable that meets this error.
    exit_code = 3


class InputError(Error, ValueError):
    """Bad input: the text has the place, what was found and what was expected."""

    exit_code = 2


class SolveError(Error, RuntimeError):
    """There is no solution."""

    exit_code = 3


class GateError(Error, RuntimeError):
    """There is a solution, but it would mislead."""

    exit_code = 4


class FinrayWarning(UserWarning):
    """A result is there, and something about it should be known."""

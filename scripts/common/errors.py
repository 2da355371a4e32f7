"""The ways in which a tool ends early, each one line and an exit code (guard.py)."""

import difflib
import reprlib


class UsageError(Exception):
    """A wrong command line."""

    exit_code = 1


class BadInput(Exception):
    """A file that is wrong. The text names file, line and column."""

    exit_code = 2


class NoSolution(Exception):
    """Something asked for that the recording does not determine."""

    exit_code = 3


def did_you_mean(name, names):
    """" (did you mean 'x'?)", or nothing if no name is near."""
    known = {candidate.lower(): candidate for candidate in names}
    near = difflib.get_close_matches(name.lower(), known, 1, 0.6)
    return f" (did you mean '{shown(known[near[0]])}'?)" if near else ""


def printable(text):
    """A text as one line of a terminal, character by character: names of files and what stands in
    them may hold line ends and control characters."""
    return "".join(c if c.isprintable() else "?" for c in text)


def shown(text, limit=60):
    """A text of a file, or a value of it, as part of one line."""
    # Of what aliases make endless, reprlib takes the beginning.
    text = text if isinstance(text, str) else reprlib.repr(text) \
        if isinstance(text, (list, dict)) else str(text)
    text = printable(text[:limit + 1])
    return text if len(text) <= limit else text[:limit] + "..."

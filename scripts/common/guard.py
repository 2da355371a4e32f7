"""How every tool in Python ends: a fault is one line on stderr and an exit code, never a traceback.

Exit codes are those of all tools: 1 wrong usage, 2 bad input, no room, no memory, 3 no solution, 130 interrupted.
"""

import argparse
import atexit
import os
import sys
import traceback
import warnings

from errors import UsageError, printable


class _OutputLost(Exception):
    """What is printed arrives nowhere."""

    exit_code = 2


class _Stdout:
    """A stream whose faults are told from those of other files, which have no name either."""

    def __init__(self, stream):
        self._stream = stream

    def __getattr__(self, name):
        return getattr(self._stream, name)

    def write(self, text):
        return self._tried(self._stream.write, text)

    def flush(self):
        self._tried(self._stream.flush)

    @staticmethod
    def _tried(what, *arguments):
        try:
            return what(*arguments)
        except OSError as error:
            raise _OutputLost(f"stdout: {error.strerror}") from error


def _line(error):
    """(exit code, what to say)."""
    if hasattr(error, "exit_code"):  # those of errors.py, and of tools that have their own
        return error.exit_code, str(error) + ("; see --help" if error.exit_code == 1 and "--help" not in str(error) else "")
    if isinstance(error, KeyboardInterrupt):
        return 130, "interrupted"
    if isinstance(error, MemoryError):
        return 2, "out of memory"
    if isinstance(error, ImportError):
        return 2, f"needs a package that is not installed ({error}); see scripts/install_dependencies"
    place = traceback.extract_tb(error.__traceback__)[-1:]
    at = f" ({os.path.basename(place[0].filename)}:{place[0].lineno})" if place else ""
    if isinstance(error, OSError) and error.strerror:
        return 2, f"{os.fsdecode(error.filename)}: {error.strerror}" if isinstance(error.filename, (str, bytes)) \
            else error.strerror + at
    said = " ".join(str(error).split())
    return 2, f"cannot work on this input: {type(error).__name__}{': ' + said[:300] if said else ''}{at}"


def _say(tool, error):
    """Prints the line of an error, and returns the exit code."""
    code, text = _line(error)
    try:
        print(f"{tool}: {printable(text)}", file=sys.stderr, flush=True)
    except (OSError, AttributeError):  # stderr is full or closed
        pass
    return code


class Parser(argparse.ArgumentParser):
    """One whose faults are wrong usage as everywhere, not argparse's exit code 2."""

    def error(self, message):
        raise UsageError(message)


def words(doc, least, most=None, flags=()):
    """The words behind the name of a script that takes so many; --help prints doc. A flag is none of them,
    but for `flags`: a script would write a file of its name."""
    given = sys.argv[1:]
    if {"-h", "-help", "--help"} & set(given):
        print(doc.strip())
        sys.exit(0)
    wrong = [word for word in given if word.startswith("-") and word not in flags]
    if wrong:
        raise UsageError(f"{wrong[0]} is not a flag")
    count = sum(word not in flags for word in given)
    if count < least or most is not None and count > most:
        expected = f"{least} or more" if most is None else str(least) if most == least else f"{least} to {most}"
        raise UsageError(f"expected {expected} argument{'s' * (expected != '1')}, found {count}")
    return given


def _finish():
    """Raises _OutputLost if stdout has not taken all."""
    if sys.stdout is None:
        raise _OutputLost("stdout: is closed")
    try:
        sys.stdout.flush()
    except _OutputLost:
        # Python flushes once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        raise


def run(tool, main, *arguments):
    """main(*arguments), whose exit code this returns, or that of what it raises."""
    stdout = sys.stdout
    try:
        if stdout is None:
            _finish()
        sys.stdout = _Stdout(stdout)
        try:
            code = main(*arguments) or 0
        finally:
            _finish()
        return code
    except SystemExit:
        raise
    except BaseException as error:
        return _say(tool, error)
    finally:
        sys.stdout = stdout


def protect(tool, name):
    """From here on the script ends as `run` does, at the import of a package too. `name` is its __name__: nothing
    happens where another script imports it."""
    if name != "__main__":
        return

    def hook(_, error, __):
        os_exit(_say(tool, error))

    def os_exit(code):
        atexit.unregister(end)
        atexit._run_exitfuncs()
        try:
            _finish()
        except _OutputLost:
            pass
        os._exit(code)

    def end():
        try:
            _finish()
        except _OutputLost as error:
            os._exit(_say(tool, error))

    warnings.simplefilter("ignore")  # a library's are not for users
    sys.excepthook = hook
    atexit.register(end)
    if sys.stdout is None:
        end()
    sys.stdout = _Stdout(sys.stdout)

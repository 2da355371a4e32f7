"""How every tool in Python ends: a fault is one line on stderr and an exit code, never a traceback.

Exit codes are those of all tools: 1 wrong usage, 2 bad input, no room, no memory, 3 no solution, 130 interrupted.
"""

import atexit
import os
import sys
import traceback
import warnings


class _OutputLost(Exception):
    """What is printed arrives nowhere."""

    exit_code = 2


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
    if isinstance(error, OSError) and error.strerror:
        where = error.filename if error.filename is not None else "stdout"
        return 2, f"{where}: {error.strerror}"
    said = " ".join(str(error).split())
    place = traceback.extract_tb(error.__traceback__)[-1:]
    at = f" ({os.path.basename(place[0].filename)}:{place[0].lineno})" if place else ""
    return 2, f"cannot work on this input: {type(error).__name__}{': ' + said[:300] if said else ''}{at}"


def _say(tool, error):
    """Prints the line of an error, and returns the exit code."""
    code, text = _line(error)
    try:
        print(f"{tool}: {text}", file=sys.stderr, flush=True)
    except (OSError, AttributeError):  # stderr is full or closed
        pass
    return code


def _finish():
    """Raises _OutputLost if stdout has not taken all."""
    if sys.stdout is None:
        raise _OutputLost("stdout: is closed")
    try:
        sys.stdout.flush()
    except OSError as error:
        # Python flushes once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        raise _OutputLost(f"stdout: {error.strerror}") from error


def run(tool, main, *arguments):
    """main(*arguments), whose exit code this returns, or that of what it raises."""
    try:
        if sys.stdout is None:
            _finish()
        try:
            code = main(*arguments) or 0
        finally:
            _finish()
        return code
    except SystemExit:
        raise
    except BaseException as error:
        return _say(tool, error)


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

"""Calls a function in a process of its own.

Libraries in C crash on some broken files, and others ask for all memory. In a child
neither ends the import: the parent says in one line what happened.
"""

import os
import pickle
import resource
import select
import signal
import sys

import limits


def _child(function, argument, size, writer):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # What a library prints is not for the user.
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    with os.fdopen(writer, "wb") as file, limits.bounded(size):
        # A library in C does not come back to Python to hear of the time.
        signal.signal(signal.SIGXCPU, signal.SIG_DFL)
        try:
            result = function(argument)
        except BaseException as error:  # the parent raises it
            try:
                data = pickle.dumps((False, error))
                pickle.loads(data)
            except Exception:  # an exception that holds an open file, or takes more arguments
                data = pickle.dumps((False, ValueError(str(error))))
            file.write(data)
        else:
            pickle.dump((True, result), file, pickle.HIGHEST_PROTOCOL)


MOST_WAIT_MS = 2**31 - 1  # of poll


def _await(reader, child, size):
    """Waits for the first bytes. A child that waits for a device, say, uses no CPU and never ends."""
    told = select.poll()
    told.register(reader, select.POLLIN)
    if not told.poll(min(MOST_WAIT_MS, 1000 * limits.WAIT_RATIO * limits.seconds(size))):
        os.kill(child, signal.SIGKILL)
        raise limits.TooLong


def call(function, argument, size):
    """function(argument), or the exception that it raises; ValueError if its process ends, TooLong
    if it takes more time than a file of so many bytes may."""
    sys.stdout.flush()
    sys.stderr.flush()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.close(reader)
            _child(function, argument, size, writer)
        finally:
            os._exit(0)
    os.close(writer)
    try:
        with os.fdopen(reader, "rb") as file:
            _await(reader, child, size)
            good, result = pickle.load(file)
    except (EOFError, pickle.UnpicklingError):  # the child ended before it had written all
        good = None
    finally:
        status = os.waitpid(child, 0)[1]
    if good is None:
        if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU:
            raise limits.TooLong
        raise ValueError("its library crashes on it")
    if good:
        return result
    raise result

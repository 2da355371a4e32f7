"""Calls a function in a process of its own.

Libraries in C crash on some broken files, and others ask for all memory. In a child
neither ends the import: the parent says in one line what happened.
"""

import os
import pickle
import resource
import signal
import sys

LEAST_BYTES, LEAST_SECONDS = 4 << 30, 60


def _limit(size):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for kind, wanted in ((resource.RLIMIT_AS, LEAST_BYTES + 100 * size),
                         (resource.RLIMIT_CPU, LEAST_SECONDS + size // 10**5)):
        hard = resource.getrlimit(kind)[1]
        if hard == resource.RLIM_INFINITY or wanted < hard:
            resource.setrlimit(kind, (wanted, hard))


def _child(function, argument, size, writer):
    try:
        _limit(size)
        # What a library prints is not for the user.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        result = (True, function(argument))
    except BaseException as error:  # the parent raises it
        result = (False, error)
    try:
        data = pickle.dumps(result)
    except Exception:  # an exception that holds an open file
        data = pickle.dumps((False, ValueError(str(result[1]))))
    with os.fdopen(writer, "wb") as file:
        file.write(data)


def call(function, argument, size):
    """function(argument), or the exception that it raises; ValueError if its process ends."""
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
    with os.fdopen(reader, "rb") as file:
        data = file.read()
    status = os.waitpid(child, 0)[1]
    if not data:
        if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU:
            raise ValueError("its library takes too long on it")
        raise ValueError("its library crashes on it")
    good, result = pickle.loads(data)
    if good:
        return result
    raise result

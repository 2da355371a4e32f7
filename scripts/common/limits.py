"""How much memory and time a file may take: the more, the larger it is.

An hour at 1 kHz passes in every format. A small file that unpacks to gigabytes does not.
"""

import contextlib
import os
import resource
import signal
import zipfile

from errors import BadInput

# Readings pack to a tenth at best where a gauge is dead; what is made to be large packs to a
# thousandth.
LEAST_UNPACKED, UNPACKED_RATIO = 32 << 20, 32
LEAST_BYTES, BYTES_RATIO = 512 << 20, 200  # of memory, beside what a process has already
LEAST_SECONDS, BYTES_A_SECOND = 8, 20000  # of CPU
WAIT_RATIO = 10  # times the CPU's seconds may pass, as where other processes have most of it
MOST_COLUMNS = 10000  # of a table


class Room:
    """How many bytes a file may still unpack to."""

    def __init__(self, path):
        self.path, self.most = path, LEAST_UNPACKED + UNPACKED_RATIO * os.path.getsize(path)
        self.left = self.most

    def take(self, count):
        """Uses up so many bytes, and returns how many these are; BadInput if there are fewer."""
        if not 0 <= count <= self.left:
            raise BadInput(f"{self.path}: unpacks to more than {self.most >> 20} MiB, which is {UNPACKED_RATIO} times its "
                           f"size and {LEAST_UNPACKED >> 20} MiB; if that is no fault, store it without compression")
        self.left -= count
        return count


def refuse_large_zip(path):
    """BadInput if the members of a zip file unpack to more than such a file may."""
    room = Room(path)
    with zipfile.ZipFile(path) as archive:
        for member in archive.infolist():
            room.take(member.file_size)


class TooLong(BaseException):
    """A process has used up its time. It is no Exception, so that no library takes it for one of its own."""

    exit_code = 2


def why(limit):
    """What to say of a file that takes too much memory or time."""
    return f"takes more {limit} than a file of its size may; if that is no fault, split it"


def _too_long(*_):
    raise TooLong(why("time"))


def seconds(size):
    """How many seconds of CPU a file of so many bytes may take."""
    return LEAST_SECONDS + size // BYTES_A_SECOND


def _in_use():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[0]) * resource.getpagesize()


def _used_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return int(used.ru_utime + used.ru_stime)


@contextlib.contextmanager
def bounded(size):
    """In it this process has the memory and time that files of so many bytes may take. Beyond
    them it gets MemoryError and TooLong."""
    before = {kind: resource.getrlimit(kind) for kind in (resource.RLIMIT_AS, resource.RLIMIT_CPU)}
    handler = signal.signal(signal.SIGXCPU, _too_long)
    try:
        for kind, wanted in ((resource.RLIMIT_AS, _in_use() + LEAST_BYTES + BYTES_RATIO * size),
                             (resource.RLIMIT_CPU, _used_seconds() + seconds(size))):
            soft, hard = before[kind]
            if soft == resource.RLIM_INFINITY or wanted < soft:
                resource.setrlimit(kind, (wanted, hard))
        yield
    finally:
        for kind, limit in before.items():
            resource.setrlimit(kind, limit)
        signal.signal(signal.SIGXCPU, handler)

"""How much memory and time a file may take: the more, the larger it is.

An hour at 1 kHz passes in every format. A small file that unpacks to gigabytes does not.
"""

import os

from errors import BadInput

# Readings pack to a tenth at best where a gauge is dead; what is made to be large packs to a
# thousandth.
LEAST_UNPACKED, UNPACKED_RATIO = 32 << 20, 32
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

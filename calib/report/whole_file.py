"""Files that appear whole or not at all. Only of the standard library, so that every script can use it."""

import os
import pathlib
import tempfile


class CannotWrite(Exception):
    exit_code = 2  # scripts/common/guard.py


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def write(path, data):
    """Writes bytes, or text as UTF-8, under a new name beside `path` and gives the file its own name.
    A link at `path` is replaced. A device or a pipe is written to."""
    path = pathlib.Path(path)
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            path.write_bytes(data.encode() if isinstance(data, str) else data)
            return
        descriptor, part = tempfile.mkstemp(prefix=".finray-", suffix=".tmp", dir=path.parent)
        try:
            with os.fdopen(descriptor, "wb") as file:
                file.write(data.encode() if isinstance(data, str) else data)
                file.flush()
                os.fsync(descriptor)  # a full disk may be reported only here
                os.fchmod(descriptor, 0o666 & ~_umask())
            os.replace(part, path)
        except BaseException:
            os.unlink(part)
            raise
    except OSError as error:
        raise CannotWrite(f"{path}: cannot be written: {error.strerror}") from error

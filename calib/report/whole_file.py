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


def _is_stream(path):
    """A device or a pipe: nothing can take its place."""
    return path.exists() and not path.is_file() and not path.is_dir()


def _fill(file, data):
    for block in [data] if isinstance(data, (bytes, str)) else data:
        file.write(block.encode() if isinstance(block, str) else block)


def _part(path, data):
    """Writes a file beside `path` that is to take its place, and returns its name."""
    descriptor, part = tempfile.mkstemp(prefix=".finray-", suffix=".tmp", dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            _fill(file, data)
            file.flush()
            os.fsync(descriptor)  # a full disk may be reported only here
            os.fchmod(descriptor, 0o666 & ~_umask())
    except BaseException:
        os.unlink(part)
        raise
    return part


def write_all(files):
    """Writes files {path: data}; data are bytes, text as UTF-8, or blocks of these. All are on the disk under new names
    beside the paths before the first one takes its place, so a full disk leaves none of them. A link is replaced, a
    device or a pipe is written to."""
    parts = {}
    try:
        for path, data in files.items():
            path = pathlib.Path(path)
            if _is_stream(path):
                with open(path, "wb") as stream:
                    _fill(stream, data)
            else:
                parts[path] = _part(path, data)
        for path in list(parts):
            os.replace(parts[path], path)
            del parts[path]
    except OSError as error:
        raise CannotWrite(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        for part in parts.values():
            os.unlink(part)


def write(path, data):
    """write_all of one file."""
    write_all({path: data})

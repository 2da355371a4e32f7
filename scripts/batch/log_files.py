"""The logs that items of --logs stand for, by the rules of finray_estimate."""

import glob
import os

from batch_config import BadInput

LOGS = ("*.csv", "*.csv.gz")


def is_below(folder, path):
    return path.startswith(folder.rstrip("/") + "/")


def folders_in(folder):
    """The folder and those below it, but no hidden ones and no links."""
    yield folder
    for entry in os.scandir(folder):
        if entry.is_dir(follow_symlinks=False) and not entry.name.startswith("."):
            yield from folders_in(entry.path)


def matches(folder, pattern):
    """The files in `folder` ("" or ending in /) that a pattern matches. ** as a part of
    the path stands for any folders, and at its end for all logs in them."""
    parts = pattern.split("/")
    if "**" not in parts:
        return [path for path in glob.glob(glob.escape(folder) + pattern)
                if os.path.isfile(path)]
    at = parts.index("**")
    before, behind = "/".join(parts[:at]), "/".join(parts[at + 1:])
    if pattern.startswith("/") and at == 1:
        before = "/"
    bases = glob.glob(glob.escape(folder) + before) if before else [folder or "."]
    return [path for base in bases if os.path.isdir(base)
            for below in folders_in(base)
            for rest in ([behind] if behind else LOGS)
            for path in matches(os.path.join(below, ""), rest)]


def files_of(item, place, out_dir):
    """A file, or the logs in a folder, or the files that a pattern matches, sorted byte
    by byte."""
    is_folder = os.path.isdir(item)
    if not is_folder and (not any(c in item for c in "*?[") or os.path.exists(item)):
        if not os.path.isfile(item):
            raise BadInput(f"{place}there is no log '{item}'")
        return [item]
    found = ([path for logs in LOGS for path in matches(os.path.join(item, ""), logs)]
             if is_folder else matches("", item))
    found = {path for path in found if not is_below(out_dir, path)}
    if not found and is_folder:
        raise BadInput(f"{item}: is a folder without *.csv and *.csv.gz; logs in its "
                       f"folders are '{os.path.join(item, '**')}'")
    if not found:
        raise BadInput(f"{place}'{item}' matches no file")
    return sorted(found, key=os.fsencode)


def without_comment(line):
    for at, character in enumerate(line):
        if character == "#" and (at == 0 or line[at - 1] in " \t"):
            return line[:at].strip()
    return line.strip()


def files_of_list(path, out_dir):
    """The items of a list: one file or pattern a line, relative to its own folder."""
    try:
        with open(path, encoding="utf-8", errors="surrogateescape") as file:
            lines = file.read().split("\n")
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    logs = []
    for number, line in enumerate(lines, 1):
        item = without_comment(line)
        if item:
            item = os.path.normpath(os.path.join(os.path.dirname(path), item))
            logs += files_of(item, f"{path}:{number}: ", out_dir)
    if not logs:
        raise BadInput(f"{path}: lists no logs")
    return logs


def check_name(log):
    """Refuses a path that a list of logs cannot hold."""
    if without_comment(log) != log or any(c in log for c in "\r\n"):
        raise BadInput(f"--logs: '{log}': a log's path must not have ' #', a line "
                       "end or a space at its end")


def expand(items, out_dir):
    """Absolute paths in the order in which finray_estimate would take them."""
    logs = []
    for item in items:
        if item.startswith("@"):
            logs += files_of_list(item[1:], out_dir)
        elif item.endswith((".txt", ".list")):
            logs += files_of_list(item, out_dir)
        else:
            logs += files_of(item, "--logs: ", out_dir)
    seen = set()
    for log in logs:
        check_name(log)
        if log in seen:
            raise BadInput(f"--logs: '{log}' is named twice")
        seen.add(log)
    return logs

"""Assigns logs to tasks.

A task estimates a group of logs, groups/<thousands>/<number>/ in --out_dir:

    logs.list       # root: /data/runs
                    /data/runs/a.csv # 81234 bytes, modified 1700000000123456789 ns

Results lie in the folder of the group as the logs lie below its root. A log stays in
its group for good. New logs, sorted byte by byte, fill up the last group, then make
new ones. A group never takes a log from outside its root, nor two logs with one
result. A list is rewritten only if its content changes, so that its time tells
whether the group has to be done again.
"""

import csv
import dataclasses
import glob
import io
import os
import re

LIST = "logs.list"
RESULT_SUFFIXES = (".gz", ".csv")


def write_if_changed(path, text):
    """Writes a file atomically, and not at all if it holds that text already."""
    content = os.fsencode(text)
    try:
        with open(path, "rb") as file:
            if file.read() == content:
                return
    except FileNotFoundError:
        pass
    os.makedirs(os.path.dirname(path), exist_ok=True)
    # A link in its place would send the content elsewhere.
    with open(path + ".new", "wb", opener=lambda name, flags: os.open(name, flags | os.O_NOFOLLOW, 0o666)) as file:
        file.write(content)
    os.rename(path + ".new", path)


def result_name(log):
    """The name of a log's result. Two logs of one folder that share it cannot be in one
    group."""
    for suffix in RESULT_SUFFIXES:
        if len(os.path.basename(log)) > len(suffix):
            log = log.removesuffix(suffix)
    return log


@dataclasses.dataclass
class Log:
    path: str
    size: int
    modified_ns: int

    def line(self):
        return f"{self.path} # {self.size} bytes, modified {self.modified_ns} ns\n"


def stat_log(path):
    status = os.stat(path)
    return Log(path, status.st_size, status.st_mtime_ns)


class Group:
    def __init__(self, number, root):
        self.number, self.root = number, root
        self.logs, self.names, self.size = [], set(), 0

    @property
    def name(self):
        return f"{self.number // 1000:03d}/{self.number % 1000:03d}"

    def add(self, log):
        self.logs.append(log)
        self.names.add(result_name(log.path))
        self.size += log.size

    def has_room(self, log, limits):
        return (not self.logs
                or (len(self.logs) < limits["logs_per_task"]
                    and self.size + log.size <= limits["log_MB_per_task"] * 1e6
                    and result_name(log.path) not in self.names))

    def takes(self, log, limits):
        below = os.path.join(self.root, "")
        return log.path.startswith(below) and self.has_room(log, limits)

    def text(self):
        return f"# root: {self.root}\n" + "".join(log.line() for log in self.logs)


def old_groups(out_dir):
    """Number, root and log paths of the existing groups."""
    for path in sorted(glob.glob(os.path.join(glob.escape(out_dir), "groups",
                                              "[0-9]*", "[0-9]*", LIST))):
        with open(path, encoding="utf-8", errors="surrogateescape") as file:
            head, *lines = file.read().splitlines()
        *_, thousands, rest, _ = path.split("/")
        yield (int(thousands) * 1000 + int(rest), head.removeprefix("# root: "),
               [re.sub(r" # \d+ bytes, modified \d+ ns$", "", line)
                for line in lines])


def assign(logs, old, limits):
    """Groups of all logs. Groups without logs keep their numbers."""
    groups, left = [], {log.path: log for log in logs}
    for number, root, paths in old:
        groups.append(Group(number, root))
        for path in paths:
            if path in left:
                groups[-1].add(left.pop(path))
    new = sorted(left.values(), key=lambda log: os.fsencode(log.path))
    while new and groups and groups[-1].takes(new[0], limits):
        groups[-1].add(new.pop(0))
    made = []
    for log in new:
        if not made or not made[-1].has_room(log, limits):
            number = groups[-1].number + 1 if groups else 0
            made.append(Group(number + len(made), ""))
        made[-1].add(log)
    for group in made:
        group.root = os.path.commonpath([os.path.dirname(log.path)
                                         for log in group.logs])
    return groups + made


def order_text(paths, groups):
    """A table of logs in the order of the whole run, with their groups."""
    group_of = {log.path: group.name for group in groups for log in group.logs}
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["log", "group"])
    table.writerows([path, group_of[path]] for path in paths)
    return text.getvalue()


def write_plan(out_dir, paths, limits):
    """Writes lists, plan/order.csv and plan/groups.txt. Returns group names."""
    groups = assign([stat_log(path) for path in paths], old_groups(out_dir), limits)
    for group in groups:
        write_if_changed(os.path.join(out_dir, "groups", group.name, LIST),
                         group.text())
    names = [group.name for group in groups if group.logs]
    write_if_changed(os.path.join(out_dir, "plan", "order.csv"),
                     order_text(paths, groups))
    write_if_changed(os.path.join(out_dir, "plan", "groups.txt"),
                     "".join(name + "\n" for name in names))
    return names

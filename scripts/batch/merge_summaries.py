"""summary.csv and summary.yaml of all groups' ones, in the order of all logs.

What a group's summaries say of a log is copied as it stands. The totals add up in
the order of the logs, so that they are those of one finray_estimate over all of
them to the last bit.
"""

import csv
import math
import os

from batch_config import BadInput
from plan_groups import write_if_changed

SUMMARIES = ("summary.csv", "summary.yaml")
LOG_ENTRY = "  - log: "


def number_text(value):
    """The shortest text that reads back as the same double, fixed or scientific,
    fixed if both are equally long: std::to_chars of C++."""
    digits, exponent = f"{value!r}", 0
    if "e" in digits:
        digits, exponent = digits.split("e")
    whole, _, fraction = digits.partition(".")
    fraction = "" if fraction == "0" else fraction
    exponent = int(exponent) - len(fraction)
    digits = (whole + fraction).lstrip("0")
    if not digits:
        return "0"
    short = digits.rstrip("0")
    exponent += len(digits) - len(short)
    point = len(short) + exponent  # digits before the decimal point
    mantissa = short[0] + ("." + short[1:] if len(short) > 1 else "")
    scientific = f"{mantissa}e{'-' if point < 1 else '+'}{abs(point - 1):02d}"
    if exponent >= 0:
        fixed = str(int(value))
    elif point > 0:
        fixed = short[:point] + "." + short[point:]
    else:
        fixed = "0." + "0" * -point + short
    return fixed if len(fixed) <= len(scientific) else scientific


class Totals:
    def __init__(self):
        self.frames, self.compared, self.squares_N2 = 0, 0, 0.0
        self.status, self.unexplained = {}, 0
        self.max_N, self.max_text = -1.0, ""

    def add(self, row):
        self.frames += int(row["frames"])
        columns = list(row)
        for status in columns[columns.index("frames") + 1:
                              columns.index("force_compared_frames")]:
            self.status[status] = self.status.get(status, 0) + int(row[status])
        self.unexplained += int(row["unexplained_frames"])
        compared = int(row["force_compared_frames"])
        if compared == 0:
            return
        self.compared += compared
        self.squares_N2 += float(row["force_squares_N2"])
        if float(row["force_max_error_N"]) > self.max_N:
            self.max_text = row["force_max_error_N"]
            self.max_N = float(self.max_text)

    def rms_N(self):
        return math.sqrt(self.squares_N2 / self.compared)

    def unsolved(self):
        return self.status["not_converged"] + self.status["bad_input"]

    def yaml(self):
        text = f"all:\n  frames: {self.frames}\n  status:\n"
        text += "".join(f"    {s}: {n}\n" for s, n in self.status.items())
        text += f"  unexplained_frames: {self.unexplained}\n"
        if self.compared > 0:
            text += (f"  force_compared_frames: {self.compared}\n"
                     f"  force_rms_error_N: {number_text(self.rms_N())}\n"
                     f"  force_max_error_N: {self.max_text}\n"
                     f"  force_squares_N2: {number_text(self.squares_N2)}\n")
        return text

    def lines(self):
        status = self.status
        force = (f"{self.rms_N():g} N rms, {self.max_N:g} N at most, over "
                 f"{self.compared} frames" if self.compared > 0
                 else "not known: no force_N in the logs")
        return (f"ok             {status['ok']}, no_contact {status['no_contact']}\n"
                f"unobservable   {status['unobservable']}, unexplained {self.unexplained}\n"
                f"not solved     {status['not_converged']} not_converged, "
                f"{status['bad_input']} bad_input\n"
                f"force error    {force}")


def read_text(path):
    # newline="": lines stay as they are.
    with open(path, encoding="utf-8", errors="surrogateescape", newline="") as file:
        return file.read()


def group_entries(folder):
    """CSV head, YAML head and, by log, (CSV line, its cells, YAML entry)."""
    lines = read_text(os.path.join(folder, "summary.csv")).splitlines(keepends=True)
    rows = list(csv.DictReader(lines))
    yaml_logs = read_text(os.path.join(folder, "summary.yaml")).rpartition("all:\n")[0]
    yaml_head, *entries = ("\n" + yaml_logs).split("\n" + LOG_ENTRY)
    if (not len(rows) == len(lines) - 1 == len(entries)
            or any("log" not in row for row in rows)):
        raise BadInput(f"{folder}/summary.yaml: expected the logs of summary.csv; "
                       "remove it, and its group is done again")
    logs = {row["log"]: (line, row, LOG_ENTRY + entry.removesuffix("\n") + "\n")
            for line, row, entry in zip(lines[1:], rows, entries)}
    return (lines[0], yaml_head[1:] + "\n"), logs


def add_row(row, group, totals):
    try:
        totals.add(row)
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"groups/{group}/summary.csv: the row of '{row['log']}' is "
                       "none of finray_estimate's") from error


def merge(out_dir):
    """Writes both summaries and returns the totals."""
    order = csv.DictReader(read_text(os.path.join(out_dir, "plan", "order.csv"))
                           .splitlines())
    order = [(row["log"], row["group"]) for row in order]
    heads, entries = {}, {}
    for group in dict.fromkeys(group for _, group in order):
        head, logs = group_entries(os.path.join(out_dir, "groups", group))
        heads.setdefault(head, group)
        entries.update(((log, group), entry) for log, entry in logs.items())
    if len(heads) > 1:
        first, other, *_ = heads.values()
        raise BadInput(f"groups {first} and {other} were done by different versions, "
                       "schemes or fingers")
    totals, csv_lines, yaml_entries = Totals(), [], []
    for log, group in order:
        if (log, group) not in entries:
            raise BadInput(f"group {group}: its summary lacks '{log}'")
        line, row, entry = entries[log, group]
        csv_lines.append(line)
        yaml_entries.append(entry)
        add_row(row, group, totals)
    (csv_head, yaml_head), = heads
    write_if_changed(os.path.join(out_dir, "summary.csv"),
                     csv_head + "".join(csv_lines))
    write_if_changed(os.path.join(out_dir, "summary.yaml"),
                     yaml_head + "".join(yaml_entries) + totals.yaml())
    return totals

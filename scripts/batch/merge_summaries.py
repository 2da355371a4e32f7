"""Merges the summaries of all groups into summary.csv and summary.yaml.

The entry of a log is copied from its group unchanged. The totals are added in the
order of the logs, so that they equal those of one finray_estimate over all of them
to the last bit.
"""

import csv
import dataclasses
import math
import os

import yaml

from batch_config import BadInput
from plan_groups import write_if_changed

SUMMARIES = ("summary.csv", "summary.yaml")
LOG_ENTRY = "  - log: "
NO_LOGS = "  []\n"
BAD_LOGS = "bad_logs:\n"


def number_text(value):
    """The shortest text that reads back as the same double, as std::to_chars of C++
    writes it: fixed or scientific, fixed if both are equally long."""
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


def force_line(key, value):
    """A line of YAML, none for what has overflowed."""
    return f"  {key}: {yaml_number(number_text(value))}\n" if math.isfinite(value) else ""


def yaml_number(text):
    """A number that YAML 1.1 reads as one: with a point before an exponent."""
    return text if "." in text else text.replace("e", ".0e")


class Totals:
    def __init__(self, columns):
        """Of summary.csv."""
        self.frames, self.bad_rows, self.compared, self.squares_N2 = 0, 0, 0, 0.0
        self.status = {status: 0 for status in columns[
            columns.index("frames") + 1:columns.index("force_compared_frames")]}
        self.unexplained, self.ended = 0, 0
        self.judged, self.far, self.variances_N2 = 0, 0, 0.0
        self.max_N = -1.0

    def add(self, row):
        self.frames += int(row["frames"])
        for status in self.status:
            self.status[status] += int(row[status])
        self.unexplained += int(row["unexplained_frames"])
        self.ended += int(row["search_ended_frames"])
        self.bad_rows += int(row["bad_rows"])
        compared = int(row["force_compared_frames"])
        if compared == 0:
            return
        self.compared += compared
        self.judged += int(row["force_judged_frames"])
        self.far += int(row["force_far_frames"])
        self.variances_N2 += float(row["force_variances_N2"])
        self.squares_N2 += float(row["force_squares_N2"])
        self.max_N = max(self.max_N, float(row["force_max_error_N"]))

    def rms_N(self):
        return math.sqrt(self.squares_N2 / self.compared)

    def unsolved(self):
        return self.status["not_converged"] + self.status["bad_input"]

    def yaml(self):
        text = f"all:\n  frames: {self.frames}\n  status:\n"
        text += "".join(f"    {s}: {n}\n" for s, n in self.status.items())
        text += (f"  unexplained_frames: {self.unexplained}\n"
                 f"  search_ended_frames: {self.ended}\n")
        if self.bad_rows > 0:
            text += f"  bad_rows: {self.bad_rows}\n"
        if self.compared > 0:
            text += (f"  force_compared_frames: {self.compared}\n"
                     + force_line("force_rms_error_N", self.rms_N())
                     + force_line("force_max_error_N", self.max_N)
                     + force_line("force_squares_N2", self.squares_N2) +
                     f"  force_judged_frames: {self.judged}\n"
                     f"  force_far_frames: {self.far}\n"
                     + force_line("force_variances_N2", self.variances_N2))
        return text

    def lines(self):
        status = self.status
        force = (f"{self.rms_N():g} N rms, {self.max_N:g} N at most, over "
                 f"{self.compared} frames" if self.compared > 0
                 else "not known: no ok or no_contact frame with a force_N")
        ended = (f"\nsearches       {self.ended} ended by the scene's limit"
                 if self.ended > 0 else "")
        return (f"ok             {status['ok']}, no_contact {status['no_contact']}\n"
                f"unobservable   {status['unobservable']}, unexplained {self.unexplained}\n"
                f"not solved     {status['not_converged']} not_converged, "
                f"{status['bad_input']} bad_input\n"
                f"force error    {force}{ended}")


def read_text(path):
    # newline="": lines stay as they are.
    with open(path, encoding="utf-8", errors="surrogateescape", newline="") as file:
        return file.read()


@dataclasses.dataclass
class Group:
    """The summaries of a group, with texts unchanged."""

    heads: tuple  # of the CSV and the YAML file
    logs: dict    # by log (CSV line, its cells, YAML entry)
    bad: dict     # by log (CSV line, YAML entry)


def entries_of(text):
    """The text before the entries, and a list of the logs' entries."""
    head, *entries = ("\n" + text).split("\n" + LOG_ENTRY)
    return head[1:] + "\n", [LOG_ENTRY + entry.removesuffix("\n") + "\n"
                             for entry in entries]


def read_group(folder):
    lines = read_text(os.path.join(folder, "summary.csv")).splitlines(keepends=True)
    rows = list(csv.DictReader(lines))
    logs_text, _, all_text = read_text(
        os.path.join(folder, "summary.yaml")).rpartition("\nall:\n")
    yaml_head, entries = entries_of(logs_text)
    yaml_head = yaml_head.removesuffix(NO_LOGS)
    _, bad_entries = entries_of(all_text.partition("\n" + BAD_LOGS)[2])
    good = len(entries)
    if (not len(rows) == len(lines) - 1 == good + len(bad_entries)
            or any("log" not in row for row in rows)):
        raise BadInput(f"{folder}/summary.yaml: expected the logs of summary.csv; "
                       "remove it, and its group is done again")
    return Group((lines[0], yaml_head),
                 {row["log"]: (line, row, entry)
                  for line, row, entry in zip(lines[1:], rows, entries)},
                 {row["log"]: (line, entry)
                  for line, row, entry in zip(lines[1 + good:], rows[good:],
                                              bad_entries)})


def warnings_of(yaml_head, yaml_entries):
    """What is doubtful, a line for each code: the first log with it, and how many more
    there are."""
    texts = [yaml_head] + [entry for entry in yaml_entries if "\n    warnings:" in entry]
    found = {}
    for text in texts:
        loaded = yaml.safe_load(text)
        entry = loaded[0] if isinstance(loaded, list) else loaded
        for warning in entry.get("warnings", []):
            found.setdefault(warning["code"], []).append(warning)
    others = {0: "", 1: " (and 1 more such log)"}
    return [first["text"] + others.get(len(more), f" (and {len(more)} more such logs)")
            + "; " + first["remedy"] for first, *more in found.values()]


def add_row(row, group, totals):
    try:
        totals.add(row)
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"groups/{group}/summary.csv: the row of '{row['log']}' is "
                       "none of finray_estimate's") from error


def merge(out_dir):
    """Writes both summaries. Returns the totals, the lines of their warnings and the
    reasons of bad logs."""
    order = csv.DictReader(read_text(os.path.join(out_dir, "plan", "order.csv"))
                           .splitlines())
    order = [(row["log"], row["group"]) for row in order]
    groups = {group: read_group(os.path.join(out_dir, "groups", group))
              for group in dict.fromkeys(group for _, group in order)}
    heads = {}
    for name, group in groups.items():
        heads.setdefault(group.heads, name)
    if len(heads) > 1:
        first, other, *_ = heads.values()
        raise BadInput(f"groups {first} and {other} were done by different versions, "
                       "schemes or fingers")
    (csv_head, yaml_head), = heads
    totals = Totals(csv_head.rstrip("\r\n").split(","))
    csv_lines, yaml_entries, bad_lines, bad_entries = [], [], [], []
    for log, name in order:
        group = groups[name]
        if log in group.logs:
            line, row, entry = group.logs[log]
            csv_lines.append(line)
            yaml_entries.append(entry)
            add_row(row, name, totals)
        elif log in group.bad:
            line, entry = group.bad[log]
            bad_lines.append(line)
            bad_entries.append(entry)
        else:
            raise BadInput(f"group {name}: its summary lacks '{log}'")
    write_if_changed(os.path.join(out_dir, "summary.csv"),
                     csv_head + "".join(csv_lines + bad_lines))
    bad_text = BAD_LOGS + "".join(bad_entries) if bad_entries else ""
    write_if_changed(os.path.join(out_dir, "summary.yaml"),
                     yaml_head + ("".join(yaml_entries) or NO_LOGS)
                     + totals.yaml() + bad_text)
    return (totals, warnings_of(yaml_head, yaml_entries),
            [yaml.safe_load(entry)[0]["reason"] for entry in bad_entries])

"""finray_import from the command line to the files."""

import importlib.metadata
import os
import platform
import sys

import numpy as np

import flags
import guard
import force_frame
import joining
import limits
import mapping_file
import output
import plateaus
import project
import readers
import recording as recordings_of
import report
import time_offset
from errors import BadInput, NoSolution, UsageError, printable, shown
from force_correction import ForceCorrection


def _print(text, **where):
    print(printable(text), **where)


class Import:
    """One run: recordings, and what is in force for them."""

    def __init__(self, values, given):
        self.flags, self.given = values, given
        self.paths = [p for p in values["logs"].split(",") if p]
        if not self.paths:
            raise UsageError("--logs: expected files, separated by commas")
        self.warnings, self.said = [], []  # said: (label, text) of the summary
        self.mapping = mapping_file.read(values["mapping"]) if values["mapping"] else \
            mapping_file.Mapping()
        self.in_force = {"time_origin": None, "join": None, "plateaus": None, "force": None}

    def chosen(self, flag, stated):
        """A flag that was given, else what the mapping states, else the flag's default."""
        return self.flags[flag] if flag in self.given or stated is None else stated

    def read(self):
        if self.flags["out"]:
            output.refuse_to_overwrite(self.paths + [self.flags["mapping"]], self.flags["out"])
        tables = [t for path in self.paths for t in readers.read(path, self.mapping)]
        names = [t.name for t in tables]
        for name in names:
            if names.count(name) > 1:
                raise BadInput(f"--logs: two tables are named '{name}'; rename a file")
        mapping_file.refuse_absent(self.mapping, tables)
        self.recordings = [recordings_of.convert(t, self.mapping) for t in tables]
        for name in self.mapping.tables:
            if not any(mapping_file.means(name, n) for n in names):
                self.warnings.append(f"{self.mapping.path}: no recording has the table "
                                     f"'{shown(name)}'")
        timed = [r for r in self.recordings if r.channels]
        for r in timed:
            if len(timed) > 1 and r.stamps is None and r.seconds is None:
                raise BadInput(f"{r.table.path}: {r.name} has no column that becomes time_s, so it "
                               "cannot be joined with the others")
            recordings_of.tell_equal_times(r, len(timed) > 1)
        self.in_force["time_origin"] = recordings_of.align_clocks(self.recordings, self.mapping)
        for r in self.recordings:
            self.warnings += r.warnings
            self.warnings += [f"{r.name}: {n[9:]}" for n in r.table.notes
                              if n.startswith("warning: ")]
        holders = {}
        for r in timed:
            for name in r.channels:
                if holders.setdefault(name, r.name) != r.name:
                    raise BadInput(f"{r.table.path}: {name} is in {holders[name]} and in {r.name}; "
                                   "map one of them to null under `tables`")
        self.used = timed

    def print_tables(self):
        for r in self.recordings:
            notes = [n for n in r.table.notes if not n.startswith("warning: ")]
            _print(f"{r.name}: {r.table.rows} rows" + "".join(f"; {n}" for n in notes))
        for line in report.understood(self.recordings) + report.not_understood(self.recordings):
            _print(line)

    def has_channels(self):
        """Whether there is anything to write; if not and there should be, BadInput."""
        if any(r.has("gauge_", "force_", "object_", "contact_", "normal_") for r in self.used):
            return True
        if self.flags["out"]:
            raise BadInput(f"{self.recordings[0].table.path}: no column is understood as one of a "
                           "log; say in --mapping what they are")
        return False

    def with_stem(self, stem):
        return next((r for r in self.used if r.has(stem)), None)

    def find_time_offset(self):
        force, gauges = self.with_stem("force_"), self.with_stem("gauge_")
        wish = self.flags["force_time_offset_s"]
        if wish not in ("auto", "estimate"):
            try:
                value = float(wish)
            except ValueError:
                value = np.inf
            if not flags.is_offset(value):
                raise UsageError("--force_time_offset_s: expected auto, estimate or a number, "
                                 f"found '{wish}'")
            if force is None or force.time is None:
                raise BadInput("--force_time_offset_s: there is no force with times")
            force.shift(value)
            return
        if wish == "auto":
            stated = force is not None and self.mapping.time_offset(
                force.name)[0] is not None
            if force is None or gauges is None or stated or force.time is None or \
                    force.table.path == gauges.table.path:
                return
        elif force is None or gauges is None or force is gauges or force.time is None:
            raise NoSolution("the time offset is not determined: it takes a table with gauges and "
                             "another one with force")
        try:
            found = time_offset.estimate(force, gauges, self.flags["longest_offset_s"])
        except NoSolution as error:
            if wish == "estimate" or isinstance(error, time_offset.ClocksApart):
                raise
            self.warnings.append(f"{error}; times are taken as they are")
            return
        for r in self.used:
            if r is force or r.table.path == force.table.path != gauges.table.path:
                r.shift(r.offset_s + found.offset_s, found.std_s)  # one file has one clock
            elif r.table.path != gauges.table.path:
                self.warnings.append(f"{r.name}: its clock is taken to agree with that of "
                                     f"{gauges.name}; if not, state its time_offset_s in the "
                                     "mapping")
        self.said.append(("time offset", f"{force.name} {1e3 * force.offset_s:+.2f} ms against "
                          f"{gauges.name}, std {1e3 * found.std_s:.2f} ms; gauges explain "
                          f"{100 * found.r2:.2f} % of the force"))

    def joined(self):
        stated = self.mapping.join
        method = self.chosen("join", stated.get("method"))
        gap = self.chosen("longest_gap_s", stated.get("longest_gap_s"))
        base = joining.base_of(self.used, self.chosen("base", stated.get("base")))
        columns, notes = joining.join(self.used, base, method, gap)
        if len(self.used) > 1:
            self.in_force["join"] = {"base": base.name, "method": method}
            if gap:
                self.in_force["join"]["longest_gap_s"] = float(gap)
        return columns, notes, base, method

    def final_columns(self):
        """(columns, noise as plateaus.average has it, notes)."""
        wanted = self.flags["plateaus"] if "plateaus" in self.given else \
            self.mapping.plateaus is not None
        if not wanted:
            columns, notes, base, method = self.joined()
            self.said.append(("rows", f"{len(next(iter(columns.values())))}, those of {base.name}"
                              + (f"; the others {method}" if len(self.used) > 1 else "")))
            return columns, [], notes
        if any(r.time is None for r in self.used):
            raise BadInput("--plateaus: needs a column that becomes time_s")
        stated = (self.mapping.plateaus or {}).get("shortest_s")
        shortest = self.chosen("shortest_plateau_s", stated)
        columns, noise, notes = plateaus.average(self.used, shortest)
        self.in_force["plateaus"] = {"shortest_s": float(shortest)}
        self.in_force["join"] = None
        self.said.append(("rows", f"{len(columns['time_s'])} places held for {shortest:g} s or "
                          "more"))
        texts = [f"{name} {row:.2g} ({one:.2g} a reading)" for name, one, row in noise
                 if name.startswith(("gauge_", "force_"))]
        if texts:
            self.said.append(("noise of rows", ", ".join(texts)))
        return columns, noise, notes

    def run(self):
        with limits.bounded(sum(os.path.getsize(p) for p in self.paths if os.path.isfile(p))):
            self._run()

    def _run(self):
        self.read()
        self.print_tables()
        if not self.has_channels():
            return
        self.find_time_offset()
        if any(r.time is not None for r in self.used):
            correction = ForceCorrection(self.flags, self.given, self.mapping)
            correction.apply(self.used, self.joined()[0])
            self.in_force["force"] = correction.kept
            self.said += correction.said
            self.warnings += correction.warnings
        columns, noise, notes = self.final_columns()
        if self.in_force["force"] is not None and correction.axes_are_unknown:
            known = force_frame.take_magnitude(columns, noise)
            if not known:
                self.warnings.append("force_N is the size of noisy readings, which is above 0 in free rows; " + (
                    "no place has two of them, so hold places longer" if self.in_force["plateaus"] else
                    "--plateaus averages the axes first"))
        if self.flags["out"]:
            output.write(self.flags["out"], columns,
                         output.mapping_text(self.recordings, self.mapping, self.in_force))
            _print(self.flags["out"])
        for line in report.summary(self.said):
            _print(line)
        for text in self.warnings + notes:
            _print(f"warning: {text}", file=sys.stderr)


def _versions():
    """The tool, and the packages that it reads with where they are installed, one a line."""
    yield f"finray_import version {project.version()}"
    yield "python " + platform.python_version()
    for package in ("numpy", "PyYAML", "scipy", "h5py", "h5py._debian_h5py_serial", "openpyxl", "pandas",
                    "zstandard", "lz4"):
        try:
            yield f"{package.partition('.')[0].lower()} {importlib.metadata.version(package)}"
        except importlib.metadata.PackageNotFoundError:
            pass


def _main(arguments):
    if any(a in ("-h", "-help", "--help") for a in arguments):
        print(flags.help_text())
    elif any(a in ("-version", "--version") for a in arguments):
        print("\n".join(_versions()))
    else:
        values, given = flags.parse(arguments)
        Import(values, given).run()


def main(arguments):
    return guard.run("finray_import", _main, arguments)

"""finray_import from the command line to the files."""

import os
import pathlib
import re
import sys

import numpy as np

import flags
import force_frame
import joining
import mapping_file
import output
import plateaus
import readers
import recording as recordings_of
import report
import time_offset
from errors import BadInput, NoSolution, UsageError, shown

class Import:
    """One run: recordings, and what is in force for them."""

    def __init__(self, values, given):
        self.flags, self.given = values, given
        self.warnings, self.said = [], []  # said: (label, text) of the summary
        self.mapping = mapping_file.read(values["mapping"]) if values["mapping"] else \
            mapping_file.Mapping()
        self.in_force = {"time_origin": None, "join": None, "plateaus": None, "force": None}

    def chosen(self, flag, stated, default=None):
        """A flag that was given, else what the mapping states, else the default."""
        if flag in self.given:
            return self.flags[flag]
        return stated if stated is not None else (
            self.flags[flag] if default is None else default)

    def read(self):
        paths = [p for p in self.flags["logs"].split(",") if p]
        tables = [t for path in paths for t in readers.read(path, self.mapping)]
        names = [t.name for t in tables]
        for name in names:
            if names.count(name) > 1:
                raise BadInput(f"--logs: two tables are named '{name}'; rename a file")
        self.recordings = [recordings_of.convert(t, self.mapping) for t in tables]
        for name in self.mapping.tables:
            files = {n.partition(":")[0] for n in names}
            if name not in names and name not in files:
                self.warnings.append(f"{self.mapping.path}: no recording has the table "
                                     f"'{shown(name)}'")
        timed = [r for r in self.recordings if r.channels]
        for r in timed:
            if len(timed) > 1 and r.stamps is None and r.seconds is None:
                raise BadInput(f"{r.table.path}: {r.name} has no column that becomes time_s, so it "
                               "cannot be joined with the others")
        self.in_force["time_origin"] = recordings_of.align_clocks(self.recordings, self.mapping)
        for r in self.recordings:
            self.warnings += r.warnings
            self.warnings += [f"{r.name}: {n[9:]}" for n in r.table.notes
                              if n.startswith("warning: ")]
        self.used = timed

    def print_tables(self):
        for r in self.recordings:
            notes = [n for n in r.table.notes if not n.startswith("warning: ")]
            print(f"{r.name}: {r.table.rows} rows" + "".join(f"; {n}" for n in notes))
        print(report.understood(self.recordings))
        for line in report.not_understood(self.recordings):
            print(line)

    def require_channels(self):
        if any(r.has("gauge_", "force_", "object_", "contact_", "normal_") for r in self.used):
            return
        hint = report.example(self.recordings)
        raise BadInput(f"{self.recordings[0].table.path}: no column is understood as one of a log"
                       + (f"; {hint}" if hint else ""))

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
            if not abs(value) < 1e9:
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
            if wish == "estimate":
                raise
            self.warnings.append(f"{error}; times are taken as they are")
            return
        force.shift(force.offset_s + found.offset_s, found.std_s)
        self.said.append(("time offset", f"{force.name} {1e3 * force.offset_s:+.2f} ms against "
                          f"{gauges.name}, std {1e3 * found.std_s:.2f} ms; gauges explain "
                          f"{100 * found.r2:.2f} % of the force"))
        own = {force.table.path, gauges.table.path}
        for r in self.used:
            if r not in (force, gauges) and r.table.path not in own:
                self.warnings.append(f"{r.name}: its clock is taken to agree with that of "
                                     f"{gauges.name}; state its time_offset_s in the mapping if not")

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

    def free_s(self):
        text = self.flags["free_s"]
        if not text:
            return self.mapping.force.get("free_s")
        try:
            first, last = map(float, text.split(":"))
        except ValueError:
            first, last = 1.0, 0.0
        if not first <= last:
            raise UsageError(f"--free_s: expected first:last, such as 0:2.5, found '{text}'")
        return [first, last]

    def set_force(self, columns):
        """Takes bias and weight off and turns the axes, in the table of the force."""
        axes = force_frame.force_axes(columns)
        if not axes:
            return
        force, stated = self.with_stem(axes[0]), self.mapping.force
        turns = bool(stated.get("turns_with_object"))
        angle = None
        if turns:
            if axes != force_frame.SENSOR_AXES or "object_angle_deg" not in columns:
                raise BadInput(f"{self.mapping.path}: force: turns_with_object: needs "
                               "force_sensor_x_N, force_sensor_y_N and object_angle_deg")
            angle = np.deg2rad(columns["object_angle_deg"])
        bias, weight = self._bias(columns, axes, turns)
        along = np.stack([columns[a] for a in axes], axis=1) - bias
        if axes == force_frame.SENSOR_AXES:
            along = force_frame.turned(along, angle) if turns else along
            degrees = self._rotation(columns, along - weight)
        values = np.stack([force.channels.pop(a) for a in axes], axis=1) - bias
        if axes != force_frame.SENSOR_AXES:
            force.channels.update(zip(axes, values.T))
            return
        if turns:
            holder = self.with_stem("object_angle_deg")
            at = joining.interpolate(holder.time, holder.channels["object_angle_deg"], force.time,
                                     "linear", 3 * (holder.period_s or 0), True)
            values = force_frame.turned(values, np.deg2rad(at))
        values = values - weight
        if degrees is None:
            force.channels["force_N"] = np.hypot(values[:, 0], values[:, 1])
        else:
            values = force_frame.turned(values, np.deg2rad(degrees))
            force.channels.update(force_x_N=values[:, 0], force_y_N=values[:, 1])

    def _bias(self, columns, axes, turns):
        """(bias of each axis, weight): stated, estimated, or 0."""
        zero = np.zeros(len(axes)), np.zeros(2)
        wish = self.flags["force_bias_N"]
        stated = self.mapping.force.get("bias_N") if "force_bias_N" not in self.given else None
        if wish != "estimate":
            try:
                stated = [float(v) for v in wish.split(":")]
            except ValueError:
                raise UsageError("--force_bias_N: expected estimate or numbers, found "
                                 f"'{wish}'") from None
            stated = stated * len(axes) if stated == [0.0] else stated
        if stated is not None:
            if len(stated) != len(axes):
                raise BadInput(f"bias_N: expected {len(axes)} numbers, for {', '.join(axes)}")
            self._keep(bias_N=[float(v) for v in stated])
            if wish == "estimate":
                self._keep_stated("bias_std_N", "tool_weight_N", "tool_weight_std_N",
                                  "turns_with_object")
            weight = (self.in_force["force"].get("tool_weight_N") if turns else None) or [0.0, 0.0]
            return np.array(stated), np.array(weight)
        free = force_frame.free_rows(columns, force_frame.gauge_noise(self.used), self.free_s())
        try:
            if turns:
                bias, weight, std, weight_std = force_frame.bias_and_weight(columns, free)
                self.said.append(("tool weight", _values(weight, weight_std)))
                self._keep(tool_weight_N=_plain(weight), tool_weight_std_N=_plain(weight_std),
                           turns_with_object=True)
            else:
                bias, std = force_frame.bias(columns, axes, free)
                weight = np.zeros(2)
        except NoSolution as error:
            if "force_bias_N" in self.given:
                raise
            self.warnings.append(f"{error}; none is taken off")
            return zero
        if not turns:
            bias = np.where(np.abs(bias) > 3 * std, bias, 0.0)
        self._keep(bias_N=_plain(bias), bias_std_N=_plain(std))
        self.said.append(("force bias", f"{_values(bias, std)} taken off, from {free.sum()} free "
                          "rows" + ("" if bias.any() else ": within 3 std of 0")))
        return bias, weight

    def _rotation(self, columns, along):
        """Degrees, or None where only the magnitude is known."""
        wish = self.flags["force_rotation_deg"]
        if wish != "estimate":
            try:
                degrees = float(wish)
            except ValueError:
                raise UsageError("--force_rotation_deg: expected estimate or a number, found "
                                 f"'{wish}'") from None
        elif self.mapping.force.get("rotation_deg") is not None and \
                "force_rotation_deg" not in self.given:
            degrees = self.mapping.force["rotation_deg"]
            self._keep_stated("rotation_std_deg")
        else:
            try:
                degrees, std = force_frame.rotation(columns, along)
            except NoSolution as error:
                if "force_rotation_deg" in self.given:
                    raise
                self.warnings.append(f"{error}; the log has the magnitude force_N")
                return None
            self._keep(rotation_std_deg=std)
            self.said.append(("force axes", f"turned by {degrees:.3f} deg into frame S, std "
                              f"{std:.3f} deg, if there is no friction"))
        self._keep(rotation_deg=float(degrees))
        return degrees

    def _keep(self, **values):
        self.in_force["force"] = {**(self.in_force["force"] or {}), **values}

    def _keep_stated(self, *keys):
        self._keep(**{key: self.mapping.force[key] for key in keys
                      if self.mapping.force.get(key) is not None})

    def final_columns(self):
        wanted = self.flags["plateaus"] if "plateaus" in self.given else \
            self.mapping.plateaus is not None
        if not wanted:
            columns, notes, base, method = self.joined()
            self.said.append(("rows", f"{len(next(iter(columns.values())))}, those of {base.name}"
                              + (f"; the others {method}" if len(self.used) > 1 else "")))
            return columns, notes
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
        return columns, notes

    def run(self):
        self.read()
        self.print_tables()
        self.require_channels()
        self.find_time_offset()
        if any(r.time is not None for r in self.used):
            self.set_force(self.joined()[0])
        columns, notes = self.final_columns()
        if self.flags["out"]:
            output.write(self.flags["out"], columns,
                         output.mapping_text(self.recordings, self.mapping, self.in_force))
            print(self.flags["out"])
        print(report.summary(self.said))
        for text in self.warnings + notes:
            print(f"warning: {text}", file=sys.stderr)


def _version():
    project = (pathlib.Path(__file__).resolve().parents[2] / "CMakeLists.txt").read_text()
    return re.search(r"project\(finray VERSION ([\d.]+)", project)[1]


def _plain(values):
    return [float(v) for v in values]


def _values(values, std):
    return ", ".join(f"{v:.4g} N (std {s:.2g})" for v, s in zip(values, std))


def main(arguments):
    if any(a in ("-h", "-help", "--help") for a in arguments):
        print(flags.help_text())
        return 0
    if any(a in ("-version", "--version") for a in arguments):
        print(f"finray_import version {_version()}")
        return 0
    try:
        values, given = flags.parse(arguments)
        Import(values, given).run()
        sys.stdout.flush()
    except UsageError as error:
        print(f"finray_import: {error}; see --help", file=sys.stderr)
        return 1
    except BadInput as error:
        print(f"finray_import: {error}", file=sys.stderr)
        return 2
    except NoSolution as error:
        print(f"finray_import: {error}", file=sys.stderr)
        return 3
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0

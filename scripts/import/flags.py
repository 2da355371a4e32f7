"""The command line, as the other executables print and check theirs."""

from errors import UsageError, did_you_mean

USAGE = ("Turns a lab's recordings into one log of finray: reads, converts, joins by time.",
         "finray_import --logs gauges.csv,rig.csv --mapping lab.yaml --out log.csv [--plateaus]")
EPILOGUE = "Exit code: 0 good, 1 wrong usage, 2 bad input, 3 not determined by the recording."

LEAST_S, MOST_S = 1e-9, 1e9  # the clock of a log resolves a nanosecond
DURATION = "a number above 0, of 1e-9 to 1e9 s"
JOINS = ["linear", "nearest", "previous"]


class Flag:
    def __init__(self, name, default, text, required=False):
        self.name, self.default, self.text, self.required = name, default, text, required


FLAGS = [
    Flag("logs", "", "recordings, separated by commas: CSV, MAT, HDF5, NPZ, XLSX, Parquet, ROS "
         "bags, MCAP", required=True),
    Flag("base", "", "table whose times the rows of the log have (default: the slower of those "
         "with gauges and force)"),
    Flag("force_bias_N", "estimate", "bias of the force sensor: estimate (from free rows), 0, or "
         "numbers of each axis as x:y"),
    Flag("force_rotation_deg", "estimate", "turn of the axes of force_sensor_x_N, "
         "force_sensor_y_N into frame S: estimate, or a number"),
    Flag("force_time_offset_s", "auto", "what is added to the times of the force: auto (estimated "
         "where force and gauges are in different files), estimate, or a number"),
    Flag("free_s", "", "when nothing touches the finger, first:last in s of the log (default: "
         "whenever the gauges read as at the start)"),
    Flag("join", "linear", "between readings of a table: linear, nearest or previous"),
    Flag("longest_gap_s", 0.0, "cells stay empty in longer gaps of a table (default: 3 of its "
         "periods)"),
    Flag("longest_offset_s", 1.0, "the time offset is sought up to this long"),
    Flag("mapping", "", "YAML with columns, delimiter, decimal: which column becomes what"),
    Flag("out", "", "log to write, and beside it its mapping; without it only tables are printed"),
    Flag("plateaus", False, "one row for each place at which everything stands still: means, and "
         "scatter of the readings"),
    Flag("shortest_plateau_s", 0.3, "with --plateaus: shorter rests are not places"),
]


def is_duration(value):
    """Whether a number may be a time to wait for, of a flag and of a mapping."""
    return LEAST_S <= value < MOST_S


def is_offset(value):
    """Whether a number may be added to times."""
    return abs(value) < MOST_S


def is_span(values):
    """Whether [first, last] is a stretch of time."""
    return values[0] <= values[1]


def default(name):
    return next(flag.default for flag in FLAGS if flag.name == name)


def help_text():
    lines = [USAGE[0], "", "  " + USAGE[1]]
    for required, title in ((True, "Required"), (False, "Optional")):
        lines += ["", title]
        for flag in FLAGS:
            if flag.required == required:
                default = str(flag.default)
                if isinstance(flag.default, bool):
                    default = default.lower()
                known = default not in ("", "0.0")
                lines.append(f"  --{flag.name:<26} {flag.text}" +
                             (f" (default: {default})" if known else ""))
    lines.append(f"  --{'version':<26} print the version and stop")
    return "\n".join(lines + ["", EPILOGUE])


def _value(flag, text):
    if isinstance(flag.default, bool):
        if text not in ("true", "false"):
            raise UsageError(f"--{flag.name}: expected true or false, found '{text}'")
        return text == "true"
    if isinstance(flag.default, float):
        try:
            value = float(text)
        except ValueError:
            value = -1.0
        if not is_duration(value):
            raise UsageError(f"--{flag.name}: expected {DURATION}, found '{text}'")
        return value
    return text


def parse(arguments):
    """Flag values by name, and the names of those that were given."""
    by_name = {flag.name: flag for flag in FLAGS}
    values, given = {flag.name: flag.default for flag in FLAGS}, set()
    rest = list(arguments)
    while rest:
        argument = rest.pop(0)
        if not argument.startswith("-"):
            raise UsageError(f"'{argument}' is not a flag; files are given as --logs a,b")
        name, equals, text = argument.lstrip("-").partition("=")
        flag = by_name.get(name)
        if flag is None and name.startswith("no") and name[2:] in by_name and \
                isinstance(by_name[name[2:]].default, bool) and not equals:
            flag, text, equals = by_name[name[2:]], "false", "="
        if flag is None:
            raise UsageError(f"--{name} is not a flag{did_you_mean(name, by_name)}")
        if not equals:
            if isinstance(flag.default, bool):
                text = "true"
            elif not rest:
                raise UsageError(f"--{name} needs a value")
            else:
                text = rest.pop(0)
        values[flag.name] = _value(flag, text)
        given.add(flag.name)
    for flag in FLAGS:
        if flag.required and not values[flag.name]:
            raise UsageError(f"--{flag.name} is missing")
    if values["join"] not in JOINS:
        raise UsageError("--join: expected linear, nearest or previous, found "
                         f"'{values['join']}'")
    if "shortest_plateau_s" in given and not values["plateaus"]:
        raise UsageError("--shortest_plateau_s is for --plateaus")
    return values, given

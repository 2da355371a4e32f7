"""A batch's settings: scripts/batch/config.yaml, a config of the user's, flags."""

import difflib
import os
import shutil

import yaml

DEFAULTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "config.yaml")
SCHEMES = ("taylor", "rigid_chain")
BAD_ROWS = ("error", "skip")
MOST_DIGITS = 17
REQUIRED = ("finger", "logs", "out_dir")
AT_LEAST_ONE = ("logs_per_task", "log_MB_per_task", "cpus_per_task", "memory_MB",
                "minutes")


class BadInput(Exception):
    """One line for the user."""

    exit_code = 2


class BadUsage(Exception):
    """One line for the user."""

    exit_code = 1


def place_of(path, before):
    """path:line:column, of the byte or character behind `before`."""
    newline = b"\n" if isinstance(before, bytes) else "\n"
    line = before.count(newline)
    return f"{path}:{line + 1}:{len(before) - before.rfind(newline)}"


def read_yaml(path):
    try:
        with open(path, "rb") as file:
            raw = file.read()
        text = raw.decode("utf-8")
        content = yaml.safe_load(text)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise BadInput(f"{place_of(path, raw[:error.start])}: "
                       "expected text in UTF-8") from error
    except yaml.reader.ReaderError as error:
        raise BadInput(f"{place_of(path, text[:error.position])}: character "
                       f"{error.character:#x} is not allowed in YAML") from error
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        said = error.problem
        before = mark.buffer[mark.pointer - mark.column:mark.pointer + 1]
        if before.strip(" ") == "\t":
            said = f"tab in the indentation, YAML wants spaces ({said})"
        raise BadInput(f"{path}:{mark.line + 1}:{mark.column + 1}: {said}") from error
    if not isinstance(content, dict):
        raise BadInput(f"{path}: expected keys with values")
    return content


def check_value(place, key, value, default):
    """Refuses a value whose type is not that of the default."""
    if key == "logs":
        value = [value] if isinstance(value, str) else value
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise BadInput(f"{place}: expected a text or a list of texts")
        return value
    if isinstance(value, bool) or not isinstance(value, type(default)):
        kind = "a whole number" if isinstance(default, int) else "a text"
        raise BadInput(f"{place}: expected {kind}, not {value!r}")
    if key in AT_LEAST_ONE and value < 1:
        raise BadInput(f"{place}: expected at least 1, not {value}")
    if key == "resolution" and value < 0:
        raise BadInput(f"{place}: expected 0 or more, not {value}")
    for choice, words in (("scheme", SCHEMES), ("bad_rows", BAD_ROWS)):
        if key == choice and value not in words:
            raise BadInput(f"{place}: expected one of {', '.join(words)}, "
                           f"not '{value}'")
    if key == "digits" and not 0 <= value <= MOST_DIGITS:
        raise BadInput(f"{place}: expected 0 to {MOST_DIGITS}, not {value}")
    return value


def in_folder(folder, item):
    """An item of `logs`, or a path, relative to `folder`."""
    at = "@" if item.startswith("@") else ""
    return at + os.path.abspath(os.path.join(folder, item[len(at):]))


def with_absolute_paths(values, folder):
    values = dict(values)
    for key in ("finger", "scene", "out_dir"):
        if values.get(key):
            values[key] = in_folder(folder, values[key])
    if "logs" in values:
        values["logs"] = [in_folder(folder, item) for item in values["logs"]]
    executable = values.get("finray_estimate", "")
    if "/" in executable:
        values["finray_estimate"] = in_folder(folder, executable)
    return values


def effective(config_path, flags):
    """All keys with their values. `flags` are the given ones, by key; their paths are
    relative to the working folder."""
    defaults = read_yaml(DEFAULTS)
    config = dict(defaults)
    if config_path:
        given = read_yaml(config_path)
        for key, value in given.items():
            if key not in defaults:
                near = difflib.get_close_matches(str(key), defaults, 1)
                hint = f"; did you mean '{near[0]}'?" if near else ""
                raise BadInput(f"{config_path}: unknown key '{key}'{hint}")
            given[key] = check_value(f"{config_path}: {key}", key, value, defaults[key])
        config.update(with_absolute_paths(
            given, os.path.dirname(os.path.abspath(config_path))))
    flags = {key: check_value("--" + key, key, value, defaults[key])
             for key, value in flags.items()}
    config.update(with_absolute_paths(flags, os.getcwd()))
    for key in REQUIRED:
        if not config[key]:
            raise BadUsage(f"--{key} is missing; see --help")
    config["finray_estimate"] = find_executable(config["finray_estimate"])
    return config


def find_executable(name):
    path = shutil.which(name)
    if path is None:
        raise BadUsage(f"finray_estimate: there is no executable '{name}'; give it "
                       "by --finray_estimate or put its folder into PATH")
    return os.path.abspath(path)

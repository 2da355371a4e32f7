"""finray_convert: brings YAML files of earlier versions to today's formats."""

import os
import pathlib
import platform
import re
import tempfile

import guard
import project
import yaml
from errors import BadInput, UsageError, did_you_mean, printable
from kinds import TODAY, kind_of, step
from yaml_node import load

HELP = """Brings files of earlier versions to today's formats. Comments stay. Files of today are copied.

  finray_convert --files 'old/finger.yaml,old/plan.yaml' --out_dir new

Required
  --files                      YAML files, separated by commas: fingers, scenes, plans, experiments, mappings, results

Optional
  --out_dir                    folder for the converted files; without it the tool only says what it would do
  --version                    print the version and stop

Exit code: 0 good, 1 wrong usage, 2 bad input, 4 without --out_dir: a file is not of today's format."""
FLAGS = ("files", "out_dir")


def parse(arguments):
    values, rest = dict.fromkeys(FLAGS, ""), list(arguments)
    while rest:
        argument = rest.pop(0)
        if not argument.startswith("-"):
            raise UsageError(f"'{argument}' is not a flag; files are given as --files a,b")
        name, equals, value = argument.lstrip("-").partition("=")
        if name not in values:
            raise UsageError(f"--{name} is not a flag{did_you_mean(name, FLAGS)}")
        if not equals and not rest:
            raise UsageError(f"--{name}: its value is missing")
        values[name] = value if equals else rest.pop(0)
    if not values["files"]:
        raise UsageError("--files is missing")
    return values


def converted(path):
    """Kind, version and today's text of a file."""
    root = load(path)
    with open(path, encoding="utf-8-sig", newline="") as file:
        text = file.read()
    if not isinstance(root, yaml.MappingNode):
        raise BadInput(f"{path}:{root.start_mark.line + 1}: expected a mapping (key: value)")
    for key, _ in root.value:
        if not isinstance(key, yaml.ScalarNode):
            raise BadInput(f"{path}:{key.start_mark.line + 1}: expected a word as a key")
    values = {key.value: value for key, value in root.value}
    kind = kind_of(values)
    if kind is None:
        raise BadInput(f"{path}: is none of finray's files: expected a {', '.join(TODAY)}")
    version = 0
    if "schema_version" in values:
        node = values["schema_version"]
        if not re.fullmatch(r"[1-9][0-9]{0,3}", str(node.value)):
            raise BadInput(f"{path}:{node.start_mark.line + 1}: schema_version: expected 1 to {TODAY[kind]}")
        version = int(node.value)
        if version > TODAY[kind]:
            raise BadInput(f"{path}:{node.start_mark.line + 1}: schema_version: a later finray has written this {kind}; "
                           f"this one knows versions to {TODAY[kind]}")
    for number in range(version, TODAY[kind]):
        text = step(kind, number)(text, yaml.compose(text, Loader=yaml.SafeLoader))
    return kind, version, text


def write(path, text):
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", newline="", dir=path.parent, prefix=f".{path.name}.",
                                     delete=False) as file:
        try:
            file.write(text)
            file.flush()
            os.fchmod(file.fileno(), 0o644)
            os.replace(file.name, path)
        except OSError:
            os.unlink(file.name)
            raise


def run(flags):
    paths = [pathlib.Path(name) for name in flags["files"].split(",") if name]
    names = [path.name for path in paths]
    for name in names:
        if flags["out_dir"] and names.count(name) > 1:
            raise UsageError(f"--files: two files are named '{name}', and --out_dir holds one; convert them one by one")
    found = [(path, *converted(path)) for path in paths]  # all are read before one is written
    out = pathlib.Path(flags["out_dir"]) if flags["out_dir"] else None
    for path in paths if out else []:
        if (out / path.name).exists() and (out / path.name).samefile(path):
            raise BadInput(f"{path}: is an input and would be written over; choose another output")
    old = 0
    for path, kind, version, text in found:
        was = f"version {version}" if version else "without schema_version"
        is_old = version < TODAY[kind]
        old += is_old
        target = ""
        if out:
            out.mkdir(parents=True, exist_ok=True)
            write(out / path.name, text)
            target = f" -> {out / path.name}"
        print(printable(f"{path}: {kind}, {was}: " + (
            f"{'now' if out else 'needs'} version {TODAY[kind]}" if is_old else "is today's") + target))
    return 4 if old and not out else 0


def _main(arguments):
    if any(a in ("-h", "-help", "--help") for a in arguments):
        print(HELP)
        return 0
    if any(a in ("-version", "--version") for a in arguments):
        print(f"finray_convert version {project.version()}\npython {platform.python_version()}\npyyaml {yaml.__version__}")
        return 0
    return run(parse(arguments))


def main(arguments):
    return guard.run("finray_convert", _main, arguments)

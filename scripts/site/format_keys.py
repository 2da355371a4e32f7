"""The keys that the readers of YAML take, found out from the readers themselves.

Each key of a sample is replaced by values that no reader takes, and left out; the errors say what was expected, whether
the key is needed, and which other keys the mapping has. So nothing here can differ from what the code does.
"""

import copy
import pathlib
import re
import subprocess
import sys
import unittest.mock

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
STRANGE = "zzzzzzzz"
# Mappings that one function reads.
SAME = {"beams.front": "beams.<beam>", "beams.back": "beams.<beam>", "tables.*.columns": "columns"}
# A pattern finds what an error expects of a value. The table writes the words beside the pattern.
EXPECTED = [
    (r"expected one of (.*?), found", lambda found: _words(found[1].split(", "))),
    (r'expected ((?:"[^"]*",? )+or \w+), found', lambda found: _words(re.split(r", | or ", found[1]))),
    (r"expected true or false", "true, false"), (r"expected a number above 0", "number > 0"),
    (r"expected a number of at least 0", "number >= 0"), (r"expected a whole number", "whole number"),
    (r"expected two numbers|a list of pairs", "list of pairs"), (r"a list of rows", "rows of numbers"), (r"takes one of", "unit"),
    (r"expected a list of .*numbers|expected \[from, to\]", "list of numbers"), (r"expected a list of (?:words|texts)", "list of texts"),
    (r"expected a number|expected another", "number"), (r"expected a mapping|needs `to`", "mapping"), (r"expected 1$", "1")]
OF_ELEMENT = {"number": "list of numbers", "mapping": "list of mappings", "list of pairs": "list of pairs", "list of numbers": "rows of numbers",
              "name": "list of names"}
MOST_WORDS = 6


def _words(words):
    words = dict.fromkeys(word if word == "'" else word.strip("'\"") for word in words)
    return " or ".join(f"`{word}`" if word.strip() else "a space" for word in words) if len(words) <= MOST_WORDS else "name"


class CompiledReader:
    """A reader of libfinray or calib, by tests/docs/format_reader.cc."""

    def __init__(self, build, kind, folder):
        self.process = subprocess.Popen([build / "tests/format_reader", kind], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, cwd=ROOT)
        self.path = pathlib.Path(folder) / f"{kind}.yaml"

    def error_of(self, document):
        self.path.write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
        self.process.stdin.write(f"{self.path}\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer.endswith("\n"):
            raise RuntimeError(f"format_reader ended at {document}")
        return re.sub(r"^\S*?\.yaml(:\d+:\d+)?: ", "", answer.strip())

    def close(self):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait()


class MappingReader:
    """The reader of finray_import's mappings, scripts/import/mapping_file.py."""

    def __init__(self, folder):
        sys.path[:0] = [str(ROOT / "scripts/import"), str(ROOT / "scripts/common")]
        import errors
        import mapping_file
        self.errors, self.read, self.path = errors, mapping_file.read, pathlib.Path(folder) / "mapping.yaml"

    def error_of(self, document):
        self.path.write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
        with unittest.mock.patch("yaml_node.did_you_mean", lambda name, keys: "; known are " + " ".join(keys)):
            try:
                self.read(str(self.path))
            except self.errors.BadInput as error:
                return re.sub(r"^\S*?\.yaml(:\d+:\d+)?: ", "", str(error))
        return ""

    def close(self):
        pass


class Key:
    def __init__(self):
        self.kinds, self.needed, self.seen, self.defaults = [], True, 0, set()

    def default(self):
        """The default that errors name; None where it differs from place to place."""
        return next(iter(self.defaults)) if len(self.defaults) == 1 else None


class Mapping:
    """keys {name: Key}; free: any key is taken, which is a header or a file's name."""

    def __init__(self):
        self.keys, self.instances, self.free = {}, 0, False

    def is_needed(self, key):
        return key.needed and key.seen == self.instances


def _at(document, where):
    for step in where:
        document = document[step]
    return document


def _with(document, where, value):
    changed = copy.deepcopy(document)
    _at(changed, where[:-1])[where[-1]] = value
    return changed


def _without(document, where):
    changed = copy.deepcopy(document)
    del _at(changed, where[:-1])[where[-1]]
    return changed


def _kinds(reader, document, where):
    """What a reader expects of a value, in the words of the table, and the defaults that its errors name."""
    key, kinds, defaults = str(where[-1]), [], set()

    def expected(value, of_element=False):
        error = reader.error_of(_with(document, where, value))
        if not re.match(rf"{re.escape(key)}\b", error):
            return None
        defaults.update(re.findall(r"; the default is (.*)", error))
        if of_element != error.startswith(f"{key}[1]"):
            return None
        return next((kind if isinstance(kind, str) else kind(found) for pattern, kind in EXPECTED
                     if (found := re.search(pattern, error))), None)

    if f"unknown key '{STRANGE}'" in reader.error_of(_with(document, where, {STRANGE: 1})) or isinstance(_at(document, where), dict):
        kinds.append("mapping")
    element = expected([STRANGE], of_element=True)
    scalar = expected(STRANGE)
    if scalar == "number":
        narrower = [expected(value) for value in (-1e29, 0, 0.5000001)]
        scalar = next((kind for kind in narrower if kind and kind != "number"), scalar)
    if element:
        kinds.append(OF_ELEMENT.get(element, f"list of {element}"))
    elif scalar is None and not kinds:
        scalar = expected({STRANGE: 1}) or "text"
    if scalar and scalar not in kinds and not (element and scalar.startswith(("list of", "rows of", "mapping"))):
        kinds.append(scalar)
    value = _at(document, where)
    if isinstance(value, str) and "number" in (scalar or "") and not re.match(r"[-+.\d]", value):
        kinds.append(f"`{value}`")
    return kinds, defaults


def _walk(reader, document, where, path, stop, mappings):
    mapping = mappings.setdefault(path, Mapping())
    mapping.instances += 1
    here = _at(document, where)
    error = reader.error_of(_with(document, [*where, STRANGE], 1) if where else {**document, STRANGE: 1})
    known = re.search(rf"unknown key '{STRANGE}'.*?; known are (.*)", error)
    mapping.free = not known
    for name in known[1].split() if known else ():
        mapping.keys.setdefault(name, Key())
    for name, value in here.items():
        key = mapping.keys.setdefault("*" if mapping.free else name, Key())
        at = [*where, name]
        key.seen += 1
        key.needed = key.needed and bool(reader.error_of(_without(document, at)))
        kinds, defaults = _kinds(reader, document, at)
        key.defaults |= defaults
        for kind in kinds:
            if kind not in key.kinds:
                key.kinds.append(kind)
        inner = f"{path}.{'*' if mapping.free else name}".lstrip(".")
        inner = SAME.get(inner, inner)
        if inner in stop:
            continue
        if isinstance(value, dict):
            _walk(reader, document, at, inner, stop, mappings)
        elif isinstance(value, list):
            for i, element in enumerate(value):
                if isinstance(element, dict):
                    _walk(reader, document, [*at, i], f"{inner}[]", stop, mappings)


def keys_of(reader, samples, stop=()):
    """{path of a mapping: Mapping} of all samples (name, document), which have to be good."""
    mappings = {}
    for name, document in samples:
        if error := reader.error_of(document):
            raise RuntimeError(f"{name}: {error}")
        _walk(reader, document, [], "", stop, mappings)
    reader.close()
    return mappings


def samples_of(kind):
    """[(name, document)]. A second plan fixes what the first one frees."""
    found = [(path.name, yaml.safe_load(path.read_text(encoding="utf-8")))
             for path in sorted((ROOT / "tests/docs/samples").glob(f"{kind}*.yaml"))]
    if kind == "plan":
        fixed = {family: {"fixed": True} for family in found[0][1]["parameters"]}
        found.insert(1, ("the plan that fixes all", {"schema_version": 1, "parameters": fixed}))
    return found

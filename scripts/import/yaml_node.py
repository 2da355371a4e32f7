"""YAML that is read strictly: every fault names file, line and key."""

import yaml

from errors import BadInput, did_you_mean, shown

MOST_BYTES = 16 << 20


def load(path):
    """The root node of a file; BadInput if it is none."""
    try:
        with open(path, "rb") as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise BadInput(f"{path}: larger than 16 MiB")
        node = yaml.compose(data.decode("utf-8-sig"), Loader=yaml.SafeLoader)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: is not UTF-8 text") from error
    except (yaml.YAMLError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        where = f":{mark.line + 1}:{mark.column + 1}" if mark else ""
        problem = shown(getattr(error, "problem", None) or error)
        if mark and mark.buffer[mark.pointer - mark.column:mark.pointer + 1].strip(" ") == "\t":
            problem = f"tab in the indentation, YAML wants spaces ({problem})"
        raise BadInput(f"{path}{where}: {problem}") from error
    if node is None:
        raise BadInput(f"{path}: is empty")
    return node


def place(path, node):
    """file:line:column of a node, both from 1."""
    return f"{path}:{node.start_mark.line + 1}:{node.start_mark.column + 1}"


class Node:
    """A mapping with the place of each key; a key that is not in `keys` is a fault."""

    def __init__(self, path, node, keys=None):
        if not isinstance(node, yaml.MappingNode):
            raise BadInput(f"{place(path, node)}: expected a mapping (key: value)")
        self.path, self.node, self.values, self.places = path, node, {}, {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise BadInput(f"{place(path, key)}: expected a word as a key")
            name, where = str(key.value), place(path, key)
            if name in self.values:
                raise BadInput(f"{where}: '{shown(name)}' is there twice")
            if keys is not None and name not in keys:
                raise BadInput(f"{where}: unknown key '{shown(name)}'{did_you_mean(name, keys)}")
            self.values[name], self.places[name] = value, where

    def fail(self, key, text):
        """A fault in the value of a key."""
        raise BadInput(f"{place(self.path, self.values[key])}: {shown(key)}: {text}")

    def is_map(self, key):
        return isinstance(self.values.get(key), yaml.MappingNode)

    def child(self, key, keys=None):
        return Node(self.path, self.values[key], keys) if key in self.values else None

    def plain(self, key):
        """The value of any kind, or None."""
        if key not in self.values:
            return None
        try:
            return yaml.SafeLoader("").construct_object(self.values[key], deep=True)
        except (yaml.YAMLError, ValueError, RecursionError) as error:
            self.fail(key, f"cannot be read: {shown(error)}")

    # Where the key is absent, the methods below return `default`, which errors name.

    def _checked(self, key, good, expected, default=None):
        if key not in self.values:
            return default
        value = self.plain(key)
        if not good(value):
            self._fail_expected(key, expected, value, default)
        return value

    def _fail_expected(self, key, expected, value, default):
        named = "" if default is None else f"; the default is {str(default).lower()}"
        found = "nothing" if value is None else f"'{shown(value)}'"
        self.fail(key, f"expected {expected}, found {found}{named}")

    def text(self, key, allowed=None, default=None, expected="a text"):
        if allowed is None:
            return self._checked(key, lambda v: isinstance(v, str) and v, expected, default)
        return self._checked(key, allowed.__contains__, "one of " + ", ".join(
            f"'{a}'" if a != "\t" else "tab" for a in allowed), default)

    def number(self, key, default=None, allowed=lambda value: True, expected="a number"):
        if key not in self.values:
            return default
        value = self.plain(key)
        if isinstance(value, str):  # PyYAML takes 8e-4 for a text
            try:
                value = float(value)
            except ValueError:
                pass
        if not _is_number(value) or not allowed(value):
            self._fail_expected(key, expected, value, default)
        return float(value)

    def integer(self, key, least, most):
        return self._checked(key, lambda v: type(v) is int and least <= v <= most,
                             f"a whole number from {least} to {most}")

    def numbers(self, key, count=None):
        value = self._checked(
            key, lambda v: isinstance(v, list) and all(map(_is_number, v)) and
            len(v) == (count or len(v)), f"a list of {count or 'some'} numbers")
        return None if value is None else [float(v) for v in value]

    def switch(self, key, default=None):
        return self._checked(key, lambda v: isinstance(v, bool), "true or false", default)

    def words(self, key):
        """A list of texts; numbers too as they are written."""
        if key not in self.values:
            return []
        items = getattr(self.values[key], "value", None)
        if not isinstance(items, list) or not all(isinstance(i, yaml.ScalarNode) for i in items):
            self.fail(key, "expected a list of words")
        return [item.value for item in items]


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e30

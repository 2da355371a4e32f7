"""Messages of ROS 2: plain CDR (OMG DDSI-RTPS 2.3, 10.2), laid out by .msg definitions.

A message is a header of four bytes, which says the order of bytes, and its fields one after
the other, each aligned to its size from behind the header.
"""

import re
import struct

import ros_definitions

PRIMITIVES = {"bool": "?", "byte": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h",
              "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q",
              "float32": "f", "float64": "d"}
BUILT_IN = ("string", "wstring", "time", "duration")
PLAIN_CDR = {b"\0\0": ">", b"\0\1": "<"}
DEEPEST, MOST_EMPTY_PARTS = 20, 1000


class UnknownType(Exception):
    """A message has a field of a type that nobody defines."""


def _short(name):
    """geometry_msgs/Point of geometry_msgs/msg/Point."""
    return name.replace("/msg/", "/")


class Definitions:
    """{type: [(field, type, array)]}; array: None, '' for a sequence, or a fixed count.

    text_of: the definition of a type that no file has to bring along, or None. A definition is
    taken apart when a message needs it, so a wrong one concerns no other topic."""

    def __init__(self, text_of=ros_definitions.text_of):
        self.texts, self.types, self.text_of = {}, {}, text_of

    def add(self, name, text):
        """A definition as bags have it: its own, and behind lines of = those that it uses."""
        parts = re.split(r"^=+\s*$", text, flags=re.M)
        self._keep(name, parts[0])
        for part in parts[1:]:
            head, _, body = part.strip().partition("\n")
            if head.startswith("MSG:"):
                self._keep(head[4:].strip(), body)

    def _keep(self, name, text):
        self.texts[_short(name)] = text
        self.types.pop(_short(name), None)

    def of(self, name):
        name = _short(name)
        if name not in self.types:
            text = self.texts[name] if name in self.texts else self.text_of(name)
            if text is None:
                raise UnknownType(name)
            self.types[name] = self._fields(name, text)
        return self.types[name]

    def _fields(self, name, text):
        package, fields = name.split("/")[0], []
        for line in text.split("\n"):
            line = line.split("#")[0].strip()
            found = re.match(r"([\w/]+)(?:<=\d+)?(\[[^\]]*\])?\s+(\w+)((?!\s*[\"'\[]).*=)?", line)
            if not found or found[4]:  # a constant is not part of a message
                continue
            kind, array, field = found[1], found[2], found[3]
            if "/" not in kind and kind not in PRIMITIVES and kind not in BUILT_IN:
                kind = "std_msgs/Header" if kind == "Header" else f"{package}/{kind}"
            if array is not None:
                array = array.strip("[]")
                array = "" if not array or array.startswith("<=") else int(array)
            fields.append((field, kind, array))
        return fields


class Reader:
    """Reads the fields of a message one after the other."""

    codes, aligned = PRIMITIVES, True

    def __init__(self, data, order):
        self.order, self.data, self.at = order, data, 0
        self.parts_left = len(data) + MOST_EMPTY_PARTS

    def values(self, code, count):
        size = struct.calcsize("=" + code)
        if count and self.aligned:
            self.at += -self.at % size
        end = self.at + size * count
        if end > len(self.data):
            raise ValueError("a message is shorter than its definition")
        out = struct.unpack(f"{self.order}{count}{code}", self.data[self.at:end])
        self.at = end
        return out

    def text(self):
        length = self.values("I", 1)[0]
        return bytes(self.values("B", length)).rstrip(b"\0").decode("utf-8", "replace")

    def field(self, definitions, kind, depth):
        if kind in self.codes:
            return self.values(self.codes[kind], 1)[0]
        if kind == "string":
            return self.text()
        if kind == "wstring":
            raise UnknownType("wstring")
        return self.message(definitions, kind, depth + 1)

    def message(self, definitions, name, depth=0):
        self.parts_left -= 1
        if depth > DEEPEST or self.parts_left < 0:
            raise ValueError("definitions are nested too deep")
        fields, out = definitions.of(name), {}
        if not fields and self.aligned:  # an empty message of CDR takes one byte
            self.values("B", 1)
        for field, kind, array in fields:
            if array is None:
                out[field] = self.field(definitions, kind, depth)
                continue
            count = self.values("I", 1)[0] if array == "" else array
            if kind in self.codes:
                out[field] = list(self.values(self.codes[kind], count))
            elif count > len(self.data):
                raise ValueError("a message is shorter than its definition")
            else:
                out[field] = [self.field(definitions, kind, depth) for _ in range(count)]
        return out


def decode(data, name, definitions):
    """The message as a dict. ValueError if it is cut, UnknownType if it cannot be known."""
    if data[:2] not in PLAIN_CDR:
        raise ValueError(f"CDR of kind {data[:2].hex()}, only plain CDR is read")
    return Reader(data[4:], PLAIN_CDR[data[:2]]).message(definitions, name)

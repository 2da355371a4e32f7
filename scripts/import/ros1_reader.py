"""ROS 1 bags, by their format 2.0 (wiki.ros.org/Bags/Format/2.0).

Messages are decoded by the definitions in the bag, as those of ROS 2 are. Nothing of a bag is
run: ROS's own readers write a module from the definitions and import it.
"""

import bz2
import mmap
import struct

import cdr
import message_tables
from errors import BadInput, shown
from limits import Room

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, CHUNK, CONNECTION = 2, 3, 5, 7
TIMES = {"time": "uint32 sec\nuint32 nsec", "duration": "int32 sec\nint32 nsec"}


class _Message(cdr.Reader):
    """A message of ROS 1: little-endian, each field right behind the one before."""

    codes, aligned = {**cdr.PRIMITIVES, "byte": "b"}, False

    def __init__(self, data):
        super().__init__(data, "<")

    def whole(self, definitions, name):
        out = self.message(definitions, name)
        if self.at != len(self.data):
            raise ValueError("a message is longer than its definition")
        return out


def _block(data, at, end):
    """(place behind it, bytes) of a block, which begins with its length."""
    if at + 4 > end:
        raise ValueError("a record ends early")
    length = struct.unpack_from("<I", data, at)[0]
    at += 4
    if length > end - at:
        raise ValueError("a record ends early")
    return at + length, data[at:at + length]


def _fields(header):
    """{name: bytes} of a header."""
    out, at = {}, 0
    while at < len(header):
        at, field = _block(header, at, len(header))
        name, _, value = field.partition(b"=")
        out[name] = value
    return out


def _field(header, name, code):
    value = header.get(name, b"")
    if len(value) != struct.calcsize(code):
        raise ValueError(f"a record has no {name.decode()}")
    return struct.unpack(code, value)


def _records(data, at):
    """(op code, header, content) of the records from a place to the end."""
    while at < len(data):
        at, header = _block(data, at, len(data))
        at, content = _block(data, at, len(data))
        header = _fields(header)
        yield _field(header, b"op", "<B")[0], header, content


def _unpacked(header, content, room):
    """The records in a chunk."""
    size, = _field(header, b"size", "<I")
    compression = header.get(b"compression", b"").decode("ascii", "replace")
    room.take(size)
    if compression == "none":
        out = content
    elif compression == "bz2":
        out = bz2.BZ2Decompressor().decompress(content, size + 1)
    elif compression == "lz4":
        import lz4.frame  # only for files that need it
        out = lz4.frame.LZ4FrameDecompressor().decompress(content, size + 1)
    else:
        raise ValueError(f"compression '{shown(compression)}' is not known")
    if len(out) != size:
        raise ValueError("a chunk has another size than its header says")
    return out


class _Bag:
    def __init__(self, room):
        self.room, self.chunks, self.expected = room, 0, None
        self.connections, self.topics = {}, message_tables.Topics()

    def take(self, data, at=0, inside=False):
        for op, header, content in _records(data, at):
            if op == MESSAGE:
                self.message(header, content)
            elif op == CONNECTION:
                self.connection(header, content)
            elif op == CHUNK and not inside:
                self.chunks += 1
                self.take(_unpacked(header, content, self.room), inside=True)
            elif op == BAG_HEADER:
                index, = _field(header, b"index_pos", "<Q")
                if index == 0:
                    raise BadInput(f"{self.room.path}: broken or cut: the bag has no index; `rosbag reindex` may mend it")
                if index > len(data):
                    raise ValueError("it ends before its index")
                self.expected, = _field(header, b"chunk_count", "<I")

    def connection(self, header, content):
        identity, = _field(header, b"conn", "<I")
        about = _fields(content)
        kind = about.get(b"type", b"").decode("utf-8", "replace")
        definitions = cdr.Definitions(TIMES.get)
        if b"message_definition" in about:
            definitions.add(kind, about[b"message_definition"].decode("utf-8", "replace"))
        self.connections[identity] = (header.get(b"topic", b"").decode("utf-8", "replace"), kind, definitions)

    def message(self, header, content):
        identity, = _field(header, b"conn", "<I")
        sec, nsec = _field(header, b"time", "<II")
        if identity not in self.connections:
            raise ValueError("a message of a connection that is not defined")
        topic, kind, definitions = self.connections[identity]
        self.topics.add(topic, sec * 10**9 + nsec, lambda: _Message(content).whole(definitions, kind))


def read(path):
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        if data[:len(MAGIC)] != MAGIC:
            version = shown(data[:len(MAGIC)].partition(b"\n")[0].decode("ascii", "replace"))
            raise BadInput(f"{path}: is a bag of another format, '{version}'; only 2.0 is read, to which `rosbag fix` "
                           "brings older ones")
        bag = _Bag(Room(path))
        bag.take(data, len(MAGIC))
        if bag.chunks != bag.expected:
            raise ValueError(f"it holds {bag.chunks} chunks, and by its header {bag.expected}")
    return bag.topics.tables(path)

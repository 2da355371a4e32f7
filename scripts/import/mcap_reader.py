"""MCAP, by its specification (mcap.dev/spec), as no Debian package reads it.

Read are messages in CDR with schemas `ros2msg`, and in JSON; chunks plain, or compressed by
lz4 (python3-lz4) or zstd (python3-zstandard). Topics in other encodings (protobuf,
flatbuffer, ros1) are left out, and the table says so. Checksums of chunks are verified.
"""

import json
import mmap
import struct
import zlib

import cdr
import message_tables
from errors import BadInput, shown
from limits import Room

MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 3, 4, 5, 6, 15


class _Fields:
    """The fields of a record, one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        if count > len(self.data) - self.at:
            raise ValueError("a record ends early")
        self.at += count
        return self.data[self.at - count:self.at]

    def number(self, code):
        return struct.unpack("<" + code, self.take(struct.calcsize("<" + code)))[0]

    def text(self):
        return self.take(self.number("I")).decode("utf-8")

    def rest(self):
        return self.take(len(self.data) - self.at)


def _records(data, start, end):
    """(opcode, content) of records between two places."""
    at = start
    while at < end:
        if at + 9 > end:
            raise ValueError("a record ends early")
        opcode, length = struct.unpack_from("<BQ", data, at)
        at += 9
        if length > end - at:
            raise ValueError("a record ends early")
        yield opcode, data[at:at + length]
        at += length


def _chunk(content, room):
    fields = _Fields(content)
    fields.take(16)  # times of the first and the last message
    size, checksum, compression = fields.number("Q"), fields.number("I"), fields.text()
    packed = fields.take(fields.number("Q"))
    room.take(size)
    if compression == "":
        data = packed
    elif compression == "zstd":
        import zstandard  # only for files that need it
        # Its one-shot call takes the size from the frame, which may say another one.
        data = zstandard.ZstdDecompressor().stream_reader(packed).read(size + 1)
    elif compression == "lz4":
        import lz4.frame
        data = lz4.frame.LZ4FrameDecompressor().decompress(packed, size + 1)
    else:
        raise ValueError(f"compression '{compression}' is not known")
    if len(data) != size or (checksum and zlib.crc32(data) != checksum):
        raise ValueError("the checksum of a chunk is wrong")
    return data


def _messages(data, room):
    """Records of schemas, channels and messages, those in chunks too."""
    for opcode, content in _records(data, len(MAGIC), len(data) - len(MAGIC)):
        if opcode == DATA_END:
            return
        if opcode == CHUNK:
            inside = _chunk(content, room)
            yield from _records(inside, 0, len(inside))
        else:
            yield opcode, content
    raise ValueError("there is no end of the data")


class _Channels:
    """Schemas and channels as they appear, and the messages of each topic."""

    def __init__(self):
        self.schemas, self.channels = {}, {}
        self.definitions, self.topics = cdr.Definitions(), message_tables.Topics()

    def schema(self, fields):
        identity, name, encoding = fields.number("H"), fields.text(), fields.text()
        text = fields.take(fields.number("I"))
        self.schemas[identity] = (name, encoding)
        if encoding == "ros2msg":
            self.definitions.add(name, text.decode("utf-8", "replace"))

    def channel(self, fields):
        identity, schema = fields.number("H"), fields.number("H")
        self.channels[identity] = (fields.text(), fields.text(), schema)

    def message(self, fields):
        identity = fields.number("H")
        fields.take(4)  # its number
        recorded = fields.number("Q")
        fields.take(8)  # when it was published
        if identity not in self.channels:
            raise ValueError("a message of a channel that is not defined")
        topic, encoding, schema = self.channels[identity]
        name, schema_encoding = self.schemas.get(schema, ("", ""))
        if encoding == "json":
            self.topics.add(topic, recorded, lambda: json.loads(fields.rest()))
        elif encoding == "cdr" and schema_encoding == "ros2msg":
            self.topics.add(topic, recorded, lambda: cdr.decode(fields.rest(), name, self.definitions))
        elif topic not in self.topics.left_out:
            self.topics.leave_out(topic, f"is in {shown(encoding)} with a schema in {shown(schema_encoding) or 'nothing'}")


def read(path):
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        if data[-len(MAGIC):] != MAGIC or len(data) < 2 * len(MAGIC):
            raise BadInput(f"{path}: broken or cut: an MCAP file ends with its magic bytes; "
                           "`mcap recover` may mend it")
        found = _Channels()
        takers = {SCHEMA: found.schema, CHANNEL: found.channel, MESSAGE: found.message}
        for opcode, content in _messages(data, Room(path)):
            if opcode in takers:
                takers[opcode](_Fields(content))
    return found.topics.tables(path)

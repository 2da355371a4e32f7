"""Writes bags of ROS 1 byte by byte, by their format 2.0, hostile ones too."""

import bz2
import struct

ARRAY = """std_msgs/MultiArrayLayout layout
float64[] data
================================================================================
MSG: std_msgs/MultiArrayLayout
std_msgs/MultiArrayDimension[] dim
uint32 data_offset
================================================================================
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
"""
HEADER = """================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
"""


def text(words):
    return struct.pack("<I", len(words)) + words.encode()


def stamp(ns):
    return struct.pack("<II", *divmod(int(ns), 10**9))


def header(ns):
    return struct.pack("<I", 7) + stamp(ns) + text("base")


def doubles(values):
    return struct.pack(f"<{len(values)}d", *values)


def array(values):
    """A Float64MultiArray without dimensions."""
    return struct.pack("<III", 0, 0, len(values)) + doubles(values)


def _block(data):
    return struct.pack("<I", len(data)) + data


def _header(op, fields):
    fields = {"op": bytes([op]), **fields}
    return _block(b"".join(_block(name.encode() + b"=" + value) for name, value in fields.items()))


def record(op, fields, data):
    return _header(op, fields) + _block(data)


def bag(connections, messages, compression="none", chunk_size=None):
    """One chunk with its index. connections: [(topic, type, definition)]; messages: [(connection, ns, bytes)]."""
    number = [struct.pack("<I", i) for i in range(len(connections) + 1)]
    known, inside, index = b"", b"", {i: b"" for i in range(len(connections))}
    for i, (topic, kind, definition) in enumerate(connections):
        fields = {"topic": topic, "type": kind, "md5sum": "0" * 32, "message_definition": definition}
        about = b"".join(_block(f"{name}={value}".encode()) for name, value in fields.items())
        known += record(7, {"conn": number[i], "topic": topic.encode()}, about)
    inside += known
    for i, ns, data in messages:
        index[i] = index.get(i, b"") + stamp(ns) + struct.pack("<I", len(inside))
        inside += record(2, {"conn": struct.pack("<I", i), "time": stamp(ns)}, data)
    if compression == "lz4":
        import lz4.frame
        packed = lz4.frame.compress(inside)
    else:
        packed = bz2.compress(inside) if compression == "bz2" else inside
    size = struct.pack("<I", len(inside) if chunk_size is None else chunk_size)
    chunk = record(5, {"compression": compression.encode(), "size": size}, packed)
    one = struct.pack("<I", 1)
    for i, places in index.items():
        count = struct.pack("<I", len(places) // 12)
        chunk += record(4, {"ver": one, "conn": struct.pack("<I", i), "count": count}, places)
    start, counts = b"#ROSBAG V2.0\n", {"conn_count": number[-1], "chunk_count": one}

    def first(place):
        head = _header(3, {"index_pos": struct.pack("<Q", place), **counts})
        return head + _block(b" " * (4096 - len(head)))

    chunk_at = len(start) + len(first(0))
    times = [ns for _, ns, _ in messages] or [0]
    fields = {"ver": one, "chunk_pos": struct.pack("<Q", chunk_at), "start_time": stamp(min(times)),
              "end_time": stamp(max(times)), "count": number[-1]}
    each = b"".join(number[i] + struct.pack("<I", len(index[i]) // 12) for i in range(len(connections)))
    return start + first(chunk_at + len(chunk)) + chunk + known + record(6, fields, each)

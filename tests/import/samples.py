"""The same readings in every format, each written by the format's own library."""

import json
import struct
import zlib

import numpy as np
import ros1_bag

ROWS = 40
XLSX_DIGITS = 15  # openpyxl writes no more
EPOCH_S = 1773237907
NAMES = ["time_s", "gauge_1_V", "gauge_2_V", "force_N"]


def readings(digits=17):
    """{column: values}; doubles with all their digits, or with fewer."""
    draw = np.random.default_rng(5)
    values = {name: draw.normal(size=ROWS) * scale
              for name, scale in zip(NAMES[1:], (0.1, 1e-7, 1e3))}
    values = {"time_s": np.cumsum(draw.uniform(0.004, 0.006, ROWS)), **values}
    return {name: np.array([float(f"{v:.{digits}g}") for v in column])
            for name, column in values.items()}


def stamps_ns():
    return EPOCH_S * 10**9 + np.rint(readings()["time_s"] * 1e9).astype(np.int64)


def csv_text(columns):
    rows = [",".join(columns)]
    rows += [",".join(repr(float(v)) for v in row) for row in zip(*columns.values())]
    return "\n".join(rows) + "\n"


def csv_of_stamps():
    """The CSV of a bag: stamps of the clock in place of seconds."""
    lines = csv_text(readings()).splitlines()
    for i, ns in enumerate(stamps_ns(), 1):
        cells = lines[i].split(",")
        cells[0] = f"{ns // 10**9}.{ns % 10**9:09d}"
        lines[i] = ",".join(cells)
    return "\n".join(lines).replace("time_s", "time") + "\n"


def write_npz(path):
    np.savez_compressed(path, **readings())


def write_mat(path):
    import scipy.io
    scipy.io.savemat(path, readings())


def write_mat4(path):
    import scipy.io
    scipy.io.savemat(path, readings(), format="4")


def write_hdf5(path):
    import h5py
    with h5py.File(path, "w") as file:
        for name, values in readings().items():
            file.create_dataset(name, data=values, compression="gzip")


def write_mat73(path):
    """As MATLAB writes -v7.3: HDF5 behind 512 bytes of its own, vectors as 1 x n."""
    import h5py
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in readings().items():
            file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = b"double"
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\0\2IM")


def write_xlsx(path):
    import openpyxl
    book = openpyxl.Workbook(write_only=True)
    sheet = book.create_sheet("run 1")
    sheet.append(NAMES)
    for row in zip(*readings(XLSX_DIGITS).values()):
        sheet.append([float(v) for v in row])
    book.save(path)


def write_parquet(path):
    import pandas
    pandas.DataFrame(readings()).to_parquet(path, engine="pyarrow")


PLAIN = {"npz": write_npz, "mat": write_mat, "v4.mat": write_mat4, "h5": write_hdf5,
         "v73.mat": write_mat73, "xlsx": write_xlsx, "parquet": write_parquet}

# Bags: one topic with an array of the three readings.
BAG_MAPPING = "columns: {data_1: gauge_1_V, data_2: gauge_2_V, data_3: force_N}\n"
ARRAY = "std_msgs/msg/Float64MultiArray"


def messages():
    """(stamp in ns, the three readings)."""
    return list(zip(stamps_ns(), np.stack([readings()[n] for n in NAMES[1:]], axis=1)))


def cdr_array(values):
    """A Float64MultiArray without dimensions; checked against Fast CDR in cdr_test.py."""
    body = struct.pack("<III", 0, 0, len(values))
    body += b"\0" * (-len(body) % 8)
    return b"\0\1\0\0" + body + struct.pack(f"<{len(values)}d", *values)


def ros1_bytes(compression="none"):
    return ros1_bag.bag([("/readings", "std_msgs/Float64MultiArray", ros1_bag.ARRAY)],
                        [(0, ns, ros1_bag.array(values)) for ns, values in messages()], compression)


def write_ros2(path):
    import sqlite3
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT "
                       "NOT NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT "
                       "NOT NULL)")
    connection.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                       "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    connection.execute("INSERT INTO topics VALUES(1, '/readings', ?, 'cdr', '')", (ARRAY,))
    connection.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)",
                           [(int(ns), cdr_array(values)) for ns, values in messages()])
    connection.commit()
    connection.close()


def _record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def mcap_bytes(compression="", encoding="cdr"):
    """An MCAP as its specification has it: one chunk, no summary."""
    schema = ("ros2msg", ros1_bag.ARRAY) if encoding == "cdr" else ("jsonschema", "{}")
    inside = _record(3, struct.pack("<H", 1) + ros1_bag.text(ARRAY) + ros1_bag.text(schema[0]) + ros1_bag.text(schema[1]))
    inside += _record(4, struct.pack("<HH", 1, 1) + ros1_bag.text("/readings") + ros1_bag.text(encoding) +
                      struct.pack("<I", 0))
    for i, (ns, values) in enumerate(messages()):
        data = cdr_array(values) if encoding == "cdr" else \
            json.dumps({"data": [float(v) for v in values]}).encode()
        inside += _record(5, struct.pack("<HIQQ", 1, i, int(ns), int(ns)) + data)
    packed = inside
    if compression == "zstd":
        import zstandard
        packed = zstandard.ZstdCompressor().compress(inside)
    elif compression == "lz4":
        import lz4.frame
        packed = lz4.frame.compress(inside)
    first, last = messages()[0][0], messages()[-1][0]
    chunk = struct.pack("<QQQI", int(first), int(last), len(inside), zlib.crc32(inside)) + \
        ros1_bag.text(compression) + struct.pack("<Q", len(packed)) + packed
    magic = b"\x89MCAP0\r\n"
    return magic + _record(1, ros1_bag.text("ros2") + ros1_bag.text("test")) + _record(6, chunk) + \
        _record(15, struct.pack("<I", 0)) + _record(2, struct.pack("<QQI", 0, 0, 0)) + magic


BAGS = {
    "bag": lambda path: path.write_bytes(ros1_bytes()),
    "bz2.bag": lambda path: path.write_bytes(ros1_bytes("bz2")),
    "lz4.bag": lambda path: path.write_bytes(ros1_bytes("lz4")),
    "db3": write_ros2,
    "mcap": lambda path: path.write_bytes(mcap_bytes()),
    "json.mcap": lambda path: path.write_bytes(mcap_bytes(encoding="json")),
    "zstd.mcap": lambda path: path.write_bytes(mcap_bytes("zstd")),
    "lz4.mcap": lambda path: path.write_bytes(mcap_bytes("lz4")),
}

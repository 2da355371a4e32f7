#!/usr/bin/python3
"""A small file takes little memory and time, whatever it unpacks to, and one line says why it is refused."""

import gzip
import io
import resource
import sqlite3
import struct
import subprocess
import time
import unittest
import zipfile
import zlib

import numpy as np
import ros1_bag
import samples
from fixture import ROOT, ImportCase

import isolated
import limits

MOST_MB, MOST_SECONDS = 1000, 10
ZEROS, MAT_ZEROS = 96 << 20, 300 << 20  # MAT has no sizes to look at before


def length_of(text):
    return len(text)


def packed_zeros(compressor, count=ZEROS, filler=b"\0" * (1 << 20)):
    out = b"".join(compressor.compress(filler) for _ in range(count // len(filler)))
    return out + compressor.flush()


def npz(shape, kept=ZEROS):
    """A column of so many zeros; the file holds `kept` bytes of them."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("gauge_1_V.npy", "w") as file:
        np.lib.format.write_array_header_1_0(file, {"descr": "<f8", "fortran_order": False, "shape": shape})
        for _ in range(kept >> 20):
            file.write(b"\0" * (1 << 20))
    return out.getvalue()


def xlsx(sheet, shared=lambda file: None):
    """A workbook of one sheet; sheet, shared: write(file)."""
    start = '<?xml version="1.0"?>'
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml."
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", start + f'<Types xmlns="{package}/content-types">'
                         f'<Override PartName="/xl/workbook.xml" ContentType="{kind}sheet.main+xml"/>'
                         f'<Override PartName="/xl/sharedStrings.xml" ContentType="{kind}sharedStrings+xml"/>'
                         f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{kind}worksheet+xml"/></Types>')
        archive.writestr("_rels/.rels", start + f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
                         f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>')
        archive.writestr("xl/workbook.xml", start + f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
                         '<sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>')
        archive.writestr("xl/_rels/workbook.xml.rels", start + f'<Relationships xmlns="{package}/relationships">'
                         f'<Relationship Id="r1" Type="{office}/worksheet" Target="worksheets/sheet1.xml"/>'
                         f'<Relationship Id="r2" Type="{office}/sharedStrings" Target="sharedStrings.xml"/>'
                         "</Relationships>")
        with archive.open("xl/sharedStrings.xml", "w") as file:
            file.write(start.encode())
            shared(file)
            file.write(f'<sst xmlns="{main}"><si><t>a</t></si></sst>'.encode())
        with archive.open("xl/worksheets/sheet1.xml", "w") as file:
            file.write(f'{start}<worksheet xmlns="{main}"><sheetData>'.encode())
            sheet(file)
            file.write(b"</sheetData></worksheet>")
    return out.getvalue()


def far_cells(file):
    """Rows whose only cell is in the last column."""
    for row in range(1, 200000):
        file.write(f'<row r="{row}"><c r="XFD{row}"><v>1</v></c></row>'.encode())


def long_text(file):
    for _ in range(ZEROS >> 20):
        file.write(b"<!--" + b" " * ((1 << 20) - 7) + b"-->")


def entities(file):
    names = "abcdefghij"
    file.write(b'<!DOCTYPE sst [<!ENTITY a "' + b"0" * 100 + b'">')
    for below, name in zip(names, names[1:]):
        file.write(f'<!ENTITY {name} "{10 * f"&{below};"}">'.encode())
    file.write(b"]><sst><si><t>&j;</t></si></sst>")


def mat5():
    """A matrix of zeros, packed."""
    name, count = b"gauge_1_V", MAT_ZEROS // 8
    head = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, count, 1) + \
        struct.pack("<II", 1, len(name)) + name + b"\0" * (-len(name) % 8) + struct.pack("<II", 9, 8 * count)
    squeeze = zlib.compressobj(9)
    data = squeeze.compress(struct.pack("<II", 14, len(head) + 8 * count) + head) + packed_zeros(squeeze, MAT_ZEROS)
    return b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + struct.pack("<II", 15, len(data)) + data


def mcap(compression, packed, size):
    chunk = struct.pack("<QQQI", 0, 0, size, 0) + ros1_bag.text(compression) + struct.pack("<Q", len(packed)) + packed
    magic = b"\x89MCAP0\r\n"
    return magic + samples._record(6, chunk) + samples._record(15, struct.pack("<I", 0)) + magic


def zstd(count):
    import zstandard
    return packed_zeros(zstandard.ZstdCompressor().compressobj(size=count), count)


def lz4():
    import lz4.frame
    return lz4.frame.compress(b"\0" * ZEROS)


def bag_of_zeros():
    import bz2
    head = ros1_bag.record(5, {"compression": b"bz2", "size": struct.pack("<I", ZEROS)},
                           packed_zeros(bz2.BZ2Compressor()))
    return b"#ROSBAG V2.0\n" + head


def nested_types():
    """An empty message of a type that holds itself by a chain of 18, each twice."""
    text = "".join(f"T{i} a\nT{i} b\n===\nMSG: lab/T{i}\n" for i in range(18))
    return ros1_bag.bag([("/a", "lab/D", text)], [(0, 5, b"")])


def hdf5(path):
    import h5py
    with h5py.File(path, "w") as file:
        file.create_dataset("gauge_1_V", shape=ZEROS // 8, dtype="f8", compression="gzip", fillvalue=0)
        file["again"] = file["/"]


def bag_of(schema):
    def write(path):
        base = sqlite3.connect(path)
        base.executescript("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
                           f"INSERT INTO topics VALUES(1, '/a', '{samples.ARRAY}', 'cdr');" + schema)
        base.commit()
        base.close()
    return write


ENDLESS = "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) " \
    "SELECT i AS id, 1 AS topic_id, i AS timestamp, x'00' AS data FROM n;"
GENERATED = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, " \
    "data BLOB AS (zeroblob(900000000)));" + \
    "INSERT INTO messages(topic_id, timestamp) VALUES(1, 1);" * 20

HOSTILE = {
    "deflated.npz": lambda: npz((ZEROS // 8,)),
    "shape.npz": lambda: npz((10**12,), 1 << 20),
    "zeros.csv.gz": lambda: gzip.compress(b"time_s,gauge_1_V\n", 9) + gzip.compress(b"0,0\n" * (ZEROS // 4), 1),
    "one_line.csv.gz": lambda: gzip.compress(b"0" * ZEROS, 1),
    "zstd.mcap": lambda: mcap("zstd", zstd(ZEROS), ZEROS),
    "zstd_says_less.mcap": lambda: mcap("zstd", zstd(ZEROS), 1000),
    "lz4.mcap": lambda: mcap("lz4", lz4(), ZEROS),
    "lz4_says_less.mcap": lambda: mcap("lz4", lz4(), 1000),
    "short_records.mcap": lambda: mcap("zstd", zstd(32 << 20), 32 << 20),
    "zeros.bag": bag_of_zeros,
    "nested.bag": nested_types,
    "text.xlsx": lambda: xlsx(lambda file: None, long_text),
    "far.xlsx": lambda: xlsx(far_cells),
    "entities.xlsx": lambda: xlsx(lambda file: file.write(b'<row r="1"><c r="A1" t="s"><v>0</v></c></row>'), entities),
    "zeros.mat": mat5,
    "zeros.h5": hdf5,
    "endless.db3": bag_of(ENDLESS),
    "generated.db3": bag_of(GENERATED),
}


class LimitsTest(ImportCase):
    def measured(self, *arguments):
        """(completed process, seconds of CPU, MB at most)."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([ROOT / "apps/finray_import", *arguments], capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, after.ru_maxrss / 1024

    def test_small_files_take_little(self):
        for name, make in HOSTILE.items():
            with self.subTest(name):
                path = self.folder / name
                try:
                    if make.__code__.co_argcount:
                        make(path)
                    else:
                        path.write_bytes(make())
                except ImportError as error:
                    self.skipTest(str(error))
                self.assertLess(path.stat().st_size, 3 << 20)
                done, seconds, megabytes = self.measured("--logs", path)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
                self.assertIn(name, done.stderr)
                self.assertLess(seconds, MOST_SECONDS)
                self.assertLess(megabytes, MOST_MB)
                path.unlink()

    def test_the_executables_have_the_same_limit(self):
        stated = f"kLeastUnpacked = {limits.LEAST_UNPACKED >> 20} << 20, kUnpackedRatio = {limits.UNPACKED_RATIO};"
        self.assertIn(stated, (ROOT / "libfinray/finray/io/line_reader.cc").read_text("utf-8"))
        said = f"{limits.LEAST_UNPACKED >> 20} MiB and {limits.UNPACKED_RATIO} times its size"
        self.assertIn(said, (ROOT / "docs/reference/formats.md").read_text("utf-8"))

    def test_a_file_of_terabytes_may_take_long(self):
        self.assertEqual(isolated.call(length_of, "abc", 10**13), 3)

    def test_a_reader_that_does_not_end_is_stopped(self):
        """A child that only computes, and one that takes memory, as a library in C does."""
        def compute(_):
            while True:
                pass

        def take(_):
            return bytearray(2 << 30)

        def wait(_):
            time.sleep(100)

        least, before = limits.LEAST_SECONDS, resource.getrlimit(resource.RLIMIT_AS)
        self.addCleanup(setattr, limits, "LEAST_SECONDS", least)
        self.addCleanup(setattr, limits, "WAIT_RATIO", limits.WAIT_RATIO)
        limits.LEAST_SECONDS, limits.WAIT_RATIO = 1, 2
        with self.assertRaises(limits.TooLong):
            isolated.call(wait, None, 0)
        with self.assertRaises(limits.TooLong):
            isolated.call(compute, None, 0)
        with self.assertRaises(MemoryError):
            isolated.call(take, None, 0)
        with self.assertRaises(limits.TooLong), limits.bounded(0):
            compute(None)
        with self.assertRaises(MemoryError), limits.bounded(0):
            take(None)
        self.assertEqual(resource.getrlimit(resource.RLIMIT_AS), before)


if __name__ == "__main__":
    unittest.main()

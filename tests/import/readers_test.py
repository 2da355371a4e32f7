#!/usr/bin/python3
"""Every format gives the log of the CSV, to the byte; broken and cut files get one line."""

import importlib.util
import os
import random
import sqlite3
import struct
import sys
import unittest

import numpy as np
import ros1_bag
import samples
from fixture import ROOT, ImportCase

BAGS = ROOT / "tests/import/bags"


class ReadersTest(ImportCase):
    def logs_of(self, writers, reference, *more):
        """Whether each format's log is the reference's; formats without library are skipped."""
        path = self.write("reference.csv", reference)
        expected = self.log_of("--logs", path)
        self.assertEqual(len(expected["time_s"]), samples.ROWS)
        for form, write in writers.items():
            with self.subTest(form):
                path = self.folder / f"a.{form}"
                try:
                    write(path)
                except ImportError as error:
                    self.skipTest(str(error))
                self.assertEqual(self.log_of("--logs", path, *more), expected)

    def test_files_give_the_log_of_the_csv(self):
        writers = {form: w for form, w in samples.PLAIN.items() if form != "xlsx"}
        self.logs_of(writers, samples.csv_text(samples.readings()))

    def test_a_workbook_gives_the_log_of_the_csv(self):
        self.logs_of({"xlsx": samples.write_xlsx},
                     samples.csv_text(samples.readings(samples.XLSX_DIGITS)))

    def test_bags_give_the_log_of_the_csv(self):
        mapping = self.write("m.yaml", samples.BAG_MAPPING)
        self.logs_of(samples.BAGS, samples.csv_of_stamps(), "--mapping", mapping)

    def test_bags_of_other_writers_give_the_log_of_the_csv(self):
        """An MCAP by MCAP's own library (zstd, indices, a summary), its messages in a bag of SQLite, and a
        bag of ROS 1 by rosbag (bz2); bags/make writes them."""
        free = ("--force_bias_N", "0", "--force_time_offset_s", "0", "--mapping")
        stamps = self.write("csv.yaml", "columns: {stamp_ns: {to: time_s, format: epoch, unit: ns}}\n")
        expected = self.log_of("--logs", BAGS / "rig.csv", *free, stamps)
        self.assertEqual(len(expected["force_y_N"]), 30)
        mapping = self.write("bag.yaml", "columns: {data_1: gauge_1_V, data_2: gauge_2_V,\n"
                             "  wrench.force.x: force_x_N, wrench.force.y: force_y_N}\n")
        for name, package in (("rig.mcap", "zstandard"), ("rig.db3", "sqlite3"), ("rig.bag", "bz2")):
            with self.subTest(name):
                if importlib.util.find_spec(package) is None:
                    self.skipTest(package)
                self.assertEqual(self.log_of("--logs", BAGS / name, *free, mapping), expected)

    def test_the_log_has_the_digits_of_the_csv(self):
        path = self.write("a.csv", samples.csv_text(samples.readings()))
        log = self.log_of("--logs", path)
        for name, values in samples.readings().items():
            self.assertEqual(log[name], [repr(float(v)) for v in values])

    def test_topics_of_a_bag_are_joined(self):
        """A wrench at 10 Hz, a stage and gauges at 100 Hz, each with stamps of its own."""
        connections = [
            ("/gauges", "sensor_msgs/JointState", "std_msgs/Header header\nstring[] name\nfloat64[] position\n"
             "float64[] velocity\n" + ros1_bag.HEADER),
            ("/stage", "geometry_msgs/PointStamped", "Header header\nPoint point\n" + ros1_bag.HEADER +
             "===\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"),
            ("/ft", "lab/Force", "Header header\nint8 MOST=3\nbyte mode\nduration age\nstring NOTE=a # b\n"
             "float32[2] wrench\n" + ros1_bag.HEADER)]
        messages = []
        for i in range(300):
            head = ros1_bag.header(samples.EPOCH_S * 10**9 + i * 10**7)
            recorded = (samples.EPOCH_S + 7) * 10**9 + i * 10**7
            names = struct.pack("<I", 2) + ros1_bag.text("a") + ros1_bag.text("b")
            joints = struct.pack("<I", 2) + ros1_bag.doubles([0.01 * i, -0.02 * i]) + struct.pack("<I", 0)
            messages.append((0, recorded, head + names + joints))
            messages.append((1, recorded, head + ros1_bag.doubles([-0.001 * i, 0.07, 0.0])))
            if i % 10 == 5:
                messages.append((2, recorded, head + struct.pack("<biiff", -1, 1, 5, 0.5 * i, 0)))
        path = self.write("run.bag", ros1_bag.bag(connections, messages))
        mapping = self.write("m.yaml", "columns:\n  position.a: gauge_1_V\n"
                             "  position.b: gauge_2_V\n  wrench_1: force_N\n"
                             "  point.x: object_x_mm\n")
        log = self.log_of("--logs", path, "--mapping", mapping, "--force_bias_N", "0")
        i = np.arange(5, 300, 10)
        for name, truth in (("time_s", 0.01 * i), ("gauge_1_V", 0.01 * i),
                            ("gauge_2_V", -0.02 * i), ("force_N", 0.5 * i),
                            ("object_x_mm", -1.0 * i)):
            np.testing.assert_allclose(np.array(log[name], dtype=float), truth, atol=1e-12)
        self.assertIn("run.bag:/ft: 30 rows; time is header.stamp", self.result.out)

    def test_structs_sheets_and_groups_are_tables(self):
        t = np.arange(0, 3, 0.01)
        gauges = {"time_s": t, "gauge_1_V": 2 * t}
        force = {"time_s": t[::10], "force_N": 3 * t[::10]}

        def mat(path):
            import scipy.io
            scipy.io.savemat(path, {"daq": gauges, "rig": force, "note": "by hand"})

        def hdf5(path):
            import h5py
            with h5py.File(path, "w") as file:
                for group, columns in (("daq", gauges), ("rig", force)):
                    for name, values in columns.items():
                        file[f"{group}/{name}"] = values

        def xlsx(path):
            import openpyxl
            book = openpyxl.Workbook()
            for title, columns in (("daq", gauges), ("rig", force)):
                sheet = book.create_sheet(title)
                sheet.append(["measured on Monday"])
                sheet.append(list(columns))
                sheet.append(["s", "N" if title == "rig" else "V"])
                for row in zip(*columns.values()):
                    sheet.append([float(v) for v in row])
            book.save(path)

        for end, write in (("mat", mat), ("h5", hdf5), ("xlsx", xlsx)):
            with self.subTest(end):
                try:
                    write(self.folder / f"a.{end}")
                except ImportError as error:
                    self.skipTest(str(error))
                log = self.log_of("--logs", self.folder / f"a.{end}", "--force_bias_N", "0")
                self.assertEqual(len(log["time_s"]), 30)
                np.testing.assert_allclose(np.array(log["gauge_1_V"], dtype=float),
                                           2 * np.array(log["time_s"], dtype=float), atol=1e-12)
                self.assertIn(f"a.{end}:rig: 30 rows", self.result.out)

    def test_a_row_of_blanks_in_a_workbook_is_none(self):
        try:
            import openpyxl
        except ImportError as error:
            self.skipTest(str(error))
        book = openpyxl.Workbook()
        for row in (["time_s", "gauge_1_V"], [0.0, 0.1], [None, " "], [0.1, 0.2]):
            book.active.append(row)
        book.save(self.folder / "a.xlsx")
        self.assertEqual(self.log_of("--logs", self.folder / "a.xlsx")["gauge_1_V"], ["0.1", "0.2"])

    def test_hdf5_reads_no_other_file_and_follows_links_within(self):
        try:
            import h5py
        except ImportError as error:
            self.skipTest(str(error))
        t = 0.01 * np.arange(100)
        os.mkfifo(self.folder / "fifo")  # who opens it waits for ever
        (self.folder / "secret").write_bytes(b"secret" * 100)
        layout = h5py.VirtualLayout((100,), "f8")
        layout[:] = h5py.VirtualSource(str(self.folder / "fifo"), "a", (100,))
        cases = {
            "root": (lambda file: file.__setitem__("self", file["/"]), None),
            "soft": (lambda file: file.__setitem__("force_N", h5py.SoftLink("/rig/Fz")), None),
            "dangling": (lambda file: file.__setitem__("force_N", h5py.SoftLink("/none/Fz")), "force_N is a link"),
            "circle": (lambda file: file.__setitem__("force_N", h5py.SoftLink("/force_N")), "force_N is a link"),
            "link": (lambda file: file.__setitem__("force_N", h5py.ExternalLink(str(self.folder / "fifo"), "/a")), "force_N is a link"),
            "storage": (lambda file: file.create_dataset("force_N", (100,), "u1", external=[
                (str(self.folder / "secret"), 0, 100)]), "the readings of force_N are in another file"),
            "fifo": (lambda file: file.create_dataset("force_N", (100,), "u1", external=[
                (str(self.folder / "fifo"), 0, 100)]), "the readings of force_N are in another file"),
            "virtual": (lambda file: file.create_virtual_dataset("force_N", layout), "the readings of force_N are in another file"),
        }
        for name, (add, words) in cases.items():
            with self.subTest(name), h5py.File(self.folder / f"{name}.h5", "w") as file:
                file["time_s"], file["gauge_1_V"] = t, 0.1 * t
                if name == "soft":
                    file["rig/Fz"] = 2 * t
                add(file)
                file.close()
                log = self.log_of("--logs", self.folder / f"{name}.h5", "--force_bias_N", "0")
                self.assertEqual("force_N" in log, name == "soft")
                self.assertEqual(len(log["gauge_1_V"]), 100)
                self.assertIn(words or "", self.result.err)

    def test_a_topic_with_a_bad_message_does_not_lose_the_others(self):
        good = [(samples.EPOCH_S * 10**9 + i * 10**7, [0.1 * i, 0.2, 0.3]) for i in range(9)]
        mapping = self.write("m.yaml", "columns: {data_1: gauge_1_V}\n")
        connections = [("/g", "std_msgs/Float64MultiArray", ros1_bag.ARRAY), ("/bad", "std_msgs/Float64MultiArray", ros1_bag.ARRAY),
                       ("/odd\x1b[31m\n", "lab/Own", "float64[x] a\n")]
        bag = ros1_bag.bag(connections, [(0, ns, ros1_bag.array(v)) for ns, v in good] +
                           [(1, ns, ros1_bag.array(v)) for ns, v in good] + [(1, 5, b"\1"), (2, 5, b"\1")])
        self.write("a.bag", bag)
        base = sqlite3.connect(self.folder / "a.db3")
        base.executescript("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
                           "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)")
        for i, topic in enumerate(("/g", "/cut", "/number", "/time", "/odd\x1b[31m\n"), 1):
            base.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr')", (i, topic, samples.ARRAY))
            for ns, values in good:
                base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (i, ns, samples.cdr_array(values)))
        for i, ns, data in ((2, 5, b"\0\1\0\0\1"), (3, 5, 12), (4, "soon", samples.cdr_array([1.0])), (5, 5, "text")):
            base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (i, ns, data))
        base.commit()
        base.close()
        end, more = samples._record(15, struct.pack("<I", 0)), b""
        topics = (("/bad", b"[1"), ("/deep", b"[" * 100000), ("/huge", b'{"a": 1e999, "b": 1%s}' % (b"0" * 400)),
                  ("/stamp", b'{"header": {"stamp": {"sec": [], "nanosec": 1}}}'), ("/odd\x1b[31m\n", b"\xff"))
        for i, (topic, data) in enumerate(topics, 2):
            more += samples._record(4, struct.pack("<HH", i, 0) + ros1_bag.text(topic) + ros1_bag.text("json") + struct.pack("<I", 0))
            more += samples._record(5, struct.pack("<HIQQ", i, 0, 5, 5) + data)
        head, _, tail = samples.mcap_bytes().rpartition(end)
        self.write("a.mcap", head + more + end + tail)
        for name, words in (("a.mcap", [f"{topic} has a message that cannot be read, its number 1: " for topic, _ in topics[:4]]),
                            ("a.bag", ("/bad has a message that cannot be read, its number 10",)),
                            ("a.db3", ("/cut has a message that cannot be read, its number 10", "/number has a message that "
                                       "cannot be read, its number 10: a message is no blob", "/time has"))):
            with self.subTest(name):
                result = self.run_import("--logs", self.folder / name, "--mapping", mapping, "--out", self.folder / "o.csv")
                self.assertEqual(result.code, 0, result.err)
                self.assertEqual((self.folder / "o.csv").read_text().count("\n"), samples.ROWS + 1 if "mcap" in name else 10)
                for text in (*words, "/odd?[31m? has"):
                    self.assertIn(text, result.err)
                self.assertNotIn("\x1b", result.out + result.err)

    def every_format(self):
        for form, write in {**samples.PLAIN, **samples.BAGS}.items():
            path = self.folder / f"whole.{form}"
            try:
                write(path)
            except ImportError:
                continue
            yield form, path.read_bytes()

    def test_cut_files_get_one_line(self):
        mapping = self.write("m.yaml", samples.BAG_MAPPING)
        for form, data in self.every_format():
            for length in [0, 20, len(data) // 3, len(data) * 4 // 5, len(data) - 1]:
                with self.subTest(f"{form}, {length} of {len(data)} bytes"):
                    path = self.write(f"cut.{form}", data[:length])
                    line = self.refused("--logs", path, "--mapping", mapping)
                    self.assertIn(f"cut.{form}", line)

    def test_broken_bytes_get_one_line_or_do_no_harm(self):
        mapping = self.write("m.yaml", samples.BAG_MAPPING)
        draw = random.Random(3)
        for form, data in self.every_format():
            for _ in range(8):
                broken = bytearray(data)
                for _ in range(draw.choice((1, 8))):
                    broken[draw.randrange(len(broken))] = draw.randrange(256)
                path = self.write(f"broken.{form}", bytes(broken))
                result = self.run_import("--logs", path, "--mapping", mapping, "--out",
                                         self.folder / "out.csv")
                with self.subTest(form):
                    self.assertIn(result.code, (0, 2), result.err)
                    if result.code == 2:
                        self.assertEqual(result.err.count("\n"), 1, result.err)

    def test_messages_that_nobody_knows_are_said(self):
        path = self.folder / "a.mcap"
        path.write_bytes(samples.mcap_bytes(encoding="protobuf"))
        self.assertIn("/readings is in protobuf", self.refused("--logs", path))
        path = self.folder / "a.db3"
        samples.write_ros2(path)
        connection = sqlite3.connect(path)
        connection.execute("INSERT INTO topics VALUES(2, '/other', 'lab_msgs/msg/Own', 'cdr', '')")
        connection.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(2, 5, x'0001000000')")
        connection.commit()
        connection.close()
        mapping = self.write("m.yaml", samples.BAG_MAPPING)
        self.log_of("--logs", path, "--mapping", mapping)
        self.assertIn("left out: /other needs the definition of lab_msgs/Own", self.result.out)

    def test_no_code_in_a_bag_of_ros_1_is_run(self):
        """ROS's reader writes constants into a module, and their names may be statements."""
        mark = self.folder / "was_run"
        code = f"open({str(mark)!r}, 'w').close(); X"
        definitions = [f"float64[] data\nint8 {code}=1\n", f"float64[] data\nstring {code}=x\n",
                       f"float64[] data\nint8 A={code}\nlab/{code} b\n===\nMSG: lab/{code}\nint8 {code}=1\n"]
        mapping = self.write("m.yaml", samples.BAG_MAPPING)
        for i, definition in enumerate(definitions):
            values = struct.pack("<I", 3) + ros1_bag.doubles([1.0, 2.0, 3.0])
            bag = ros1_bag.bag([("/a", "lab/Own", definition)],
                               [(0, samples.EPOCH_S * 10**9 + k, values) for k in (1, 2)])
            for name in ("gauges.csv", "a.bag", "a.mcap"):
                with self.subTest(f"{i}, {name}"):
                    result = self.run_import("--logs", self.write(name, bag), "--mapping", mapping)
                    self.assertFalse(mark.exists())
                    self.assertEqual(result.code, 0, result.err)
                    self.assertIn(f"{name}:/a: 2 rows", result.out)
        self.assertFalse({"rosbag", "genpy", "genmsg"} & set(sys.modules))

    def test_bags_of_ros_1_that_do_not_hold_what_they_say(self):
        array = [("/a", "std_msgs/Float64MultiArray", ros1_bag.ARRAY)]
        wide = ros1_bag.array([0.0] * 20000)
        nothing = "".join(f"T{i} a\nT{i} b\n===\nMSG: lab/T{i}\n" for i in range(18))
        for why, data in (
                ("longer than its definition", ros1_bag.bag(array, [(0, 5, ros1_bag.array([1.0]) + b"x")])),
                ("connection that is not defined", ros1_bag.bag(array, [(3, 5, ros1_bag.array([1.0]))])),
                ("another size", ros1_bag.bag(array, [(0, 5, ros1_bag.array([1.0]))], "bz2", chunk_size=40)),
                ("unpacks to more than", ros1_bag.bag(array, [], "bz2", chunk_size=1 << 31)),
                ("compression 'none2' is not known", ros1_bag.bag(array, [], "none2")),
                ("a bag of another format, '#ROSBAG V1.2'", b"#ROSBAG V1.2\n" + b"\0" * 40),
                ("nested too deep", ros1_bag.bag([("/a", "lab/D", nothing)], [(0, 5, b"")])),
                ("more than 10000 numbers", ros1_bag.bag(array, [(0, 5, wide)]))):
            with self.subTest(why):
                self.assertIn(why, self.refused("--logs", self.write("a.bag", data)))
        unknown = ros1_bag.bag(array + [("/b", "lab/Own", "Other o\n"), ("/image", array[0][1], ros1_bag.ARRAY)],
                               [(0, i, ros1_bag.array([1.0, 2.0, 3.0])) for i in (5, 6)] + [(1, 5, b""), (2, 5, wide)])
        result = self.run_import("--logs", self.write("b.bag", unknown), "--mapping",
                                 self.write("m.yaml", samples.BAG_MAPPING))
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("/b needs the definition of lab/Other", result.out)
        self.assertIn("/image has more than 10000 numbers a message", result.out)

    def test_parquet_without_its_library_says_so(self):
        try:
            import pyarrow  # noqa: F401
            self.skipTest("pyarrow is installed")
        except ImportError:
            pass
        line = self.refused("--logs", self.write("a.parquet", b"PAR1" + b"\0" * 40 + b"PAR1"))
        self.assertIn("pyarrow", line)

    def test_missing_files_and_folders_get_one_line(self):
        self.assertIn("no such file", self.refused("--logs", self.folder / "none.csv"))
        self.assertIn("is not a file", self.refused("--logs", self.folder))

    def test_a_yaml_file_is_no_recording(self):
        self.assertIn("is a YAML file, expected a recording",
                      self.refused("--logs", self.write("a.yaml", b"a: 1\n")))


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""cdr.py reads what Fast CDR writes, the library by which ROS 2 writes its bags."""

import os
import shutil
import subprocess
import unittest

import samples
from fixture import ImportCase

import cdr
import message_tables

WRITER = r"""
#include <fastcdr/Cdr.h>
#include <fstream>
#include <string>
#include <vector>
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
template <class Write>
void File(const char* name, Cdr::Endianness order, Write write) {
  FastBuffer buffer;
  Cdr out(buffer, order, Cdr::DDS_CDR);
  out.serialize_encapsulation();
  write(out);
  std::ofstream(name, std::ios::binary).write(buffer.getBuffer(), out.getSerializedDataLength());
}
void Header(Cdr& out) {
  out << int32_t(1773237907) << uint32_t(123456789) << std::string("base");
}
int main() {
  for (const auto order : {Cdr::LITTLE_ENDIANNESS, Cdr::BIG_ENDIANNESS}) {
    const std::string end = order == Cdr::LITTLE_ENDIANNESS ? ".little" : ".big";
    File(("wrench" + end).c_str(), order, [](Cdr& out) {
      Header(out);
      for (int i = 1; i <= 6; ++i) out << 0.1 * i;
    });
    File(("joints" + end).c_str(), order, [](Cdr& out) {
      Header(out);
      out << std::vector<std::string>{"finger", "a"} << std::vector<double>{0.1, -0.2}
          << std::vector<double>{} << std::vector<double>{1e-9, 3};
    });
    File(("array" + end).c_str(), order, [](Cdr& out) {
      out << uint32_t(1) << std::string("row") << uint32_t(3) << uint32_t(3) << uint32_t(0)
          << std::vector<double>{0.1, 0.2, 0.3};
    });
    File(("odd" + end).c_str(), order, [](Cdr& out) {
      out << true << int16_t(-5) << uint8_t(7) << int64_t(-1) << 0.5f << uint8_t(200);
      out << 1.5 << 2.5;
    });
  }
}
"""
HEADER = {"stamp": {"sec": 1773237907, "nanosec": 123456789}, "frame_id": "base"}


class CdrTest(ImportCase):
    def test_reads_what_fast_cdr_writes(self):
        if not shutil.which("g++") or not os.path.exists("/usr/include/fastcdr/Cdr.h"):
            self.skipTest("libfastcdr-dev or g++ is not installed")
        source = self.write("writer.cc", WRITER)
        subprocess.run(["g++", "-O0", source, "-o", self.folder / "writer", "-lfastcdr"],
                       check=True)
        subprocess.run(["./writer"], cwd=self.folder, check=True)
        definitions = cdr.Definitions()
        definitions.add("lab/msg/Odd", "bool on\nint16 a\nuint8 FULL=3\nuint8 b # bits\n"
                                       "int64 c\nfloat32 d\nchar e\nPair[1] p\n"
                                       "=====\nMSG: lab/Pair\nfloat64[2] xy\n")
        xyz = [dict(zip("xyz", (0.1 * i for i in ids))) for ids in ((1, 2, 3), (4, 5, 6))]
        expected = {
            ("wrench", "geometry_msgs/msg/WrenchStamped"):
                {"header": HEADER, "wrench": {"force": xyz[0], "torque": xyz[1]}},
            ("joints", "sensor_msgs/msg/JointState"):
                {"header": HEADER, "name": ["finger", "a"], "position": [0.1, -0.2],
                 "velocity": [], "effort": [1e-9, 3.0]},
            ("array", samples.ARRAY):
                {"layout": {"dim": [{"label": "row", "size": 3, "stride": 3}], "data_offset": 0},
                 "data": [0.1, 0.2, 0.3]},
            ("odd", "lab/msg/Odd"):
                {"on": True, "a": -5, "b": 7, "c": -1, "d": 0.5, "e": 200,
                 "p": [{"xy": [1.5, 2.5]}]}}
        for (name, kind), message in expected.items():
            for order in ("little", "big"):
                with self.subTest(f"{name}, {order}"):
                    data = (self.folder / f"{name}.{order}").read_bytes()
                    self.assertEqual(cdr.decode(data, kind, definitions), message)
                    with self.assertRaises(ValueError):
                        cdr.decode(data[:-9], kind, definitions)

    def test_the_writer_of_the_samples_is_read(self):
        message = cdr.decode(samples.cdr_array([1.5, -2.5]), samples.ARRAY, cdr.Definitions())
        self.assertEqual(message["data"], [1.5, -2.5])

    def test_hostile_lengths_end_in_one_error(self):
        data = bytearray(samples.cdr_array([1.0]))
        data[12:16] = b"\xff\xff\xff\xff"
        with self.assertRaises(ValueError):
            cdr.decode(bytes(data), samples.ARRAY, cdr.Definitions())

    def test_fields_get_names_units_and_stamps(self):
        message = {"header": HEADER, "name": ["a", "b"], "position": [1.0, 2.0],
                   "wrench": {"force": {"x": 3.0}}}
        topics = message_tables.Topics()
        topics.add("/t", 5, lambda: message)
        table, = topics.tables("x.bag")
        cells = {c.name: (list(c.cells), c.unit) for c in table.columns}
        self.assertEqual(cells, {"time": ([1773237907123456789], "ns"), "position.a": ([1.0], ""),
                                 "position.b": ([2.0], ""), "wrench.force.x": ([3.0], "N")})


if __name__ == "__main__":
    unittest.main()

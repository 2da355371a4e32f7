#!/usr/bin/python3
"""Every format gives the log of the CSV, to the byte; broken and cut files get one line."""

import random
import unittest

import samples
from fixture import ImportCase


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

    def test_the_log_has_the_digits_of_the_csv(self):
        path = self.write("a.csv", samples.csv_text(samples.readings()))
        log = self.log_of("--logs", path)
        for name, values in samples.readings().items():
            self.assertEqual(log[name], [repr(float(v)) for v in values])

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
            for length in [0, 1, 20] + [len(data) * k // 7 for k in range(1, 7)] + [len(data) - 1]:
                with self.subTest(f"{form}, {length} of {len(data)} bytes"):
                    path = self.write(f"cut.{form}", data[:length])
                    line = self.refused("--logs", path, "--mapping", mapping)
                    self.assertIn(f"cut.{form}", line)

    def test_broken_bytes_get_one_line_or_do_no_harm(self):
        mapping = self.write("m.yaml", samples.BAG_MAPPING)
        draw = random.Random(3)
        for form, data in self.every_format():
            for _ in range(25):
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


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""finray_import as the other executables: help, flags, exit codes, files whole or not at all."""

import gzip
import os
import pathlib
import re
import subprocess
import unittest

from fixture import ROOT, ImportCase

import flags
import import_log

TOOL = ROOT / "apps/finray_import"
LOG = "time_s,gauge_1_V,force_N\n0,0.1,0\n1,0.2,1\n"


class CommandLineTest(ImportCase):
    def call(self, *arguments, **how):
        return subprocess.run([TOOL, *map(str, arguments)], capture_output=True, text=True, **how)

    def test_help_has_every_flag_the_required_ones_first(self):
        done = self.call("--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        required, optional = done.stdout.split("\nOptional\n")
        self.assertIn("\nRequired\n  --logs ", required)
        self.assertEqual(set(re.findall(r"^  --(\w+)", done.stdout, re.M)),
                         {flag.name for flag in flags.FLAGS} | {"version"})
        self.assertIn("--out log.csv", done.stdout)
        self.assertIn("Exit code: 0 good, 1 wrong usage, 2 bad input", optional)

    def test_a_wrong_command_line_is_one_line_and_exit_1(self):
        for arguments, words in (
                (["--log", "a"], "did you mean 'logs'"), ([], "--logs is missing"),
                (["--logs"], "needs a value"), (["a.csv"], "is not a flag"),
                (["--logs", "a", "--join", "cubic"], "linear, nearest or previous"),
                (["--logs", "a", "--longest_gap_s", "-1"], "a number above 0"),
                (["--logs", "a", "--plateaus=maybe"], "true or false"),
                (["--logs", "a", "--shortest_plateau_s", "1"], "--plateaus")):
            with self.subTest(arguments):
                done = self.call(*arguments)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertEqual(done.stderr.count("\n"), 1)
                self.assertIn(words, done.stderr)

    def test_values_of_flags_that_make_no_sense_are_exit_1(self):
        path = self.write("a.csv", LOG)
        for flag in ("--force_time_offset_s", "--force_bias_N", "--free_s"):
            with self.subTest(flag):
                self.refused("--logs", path, flag, "soon", code=1)

    def test_without_out_nothing_is_written(self):
        path = self.write("a.csv", LOG)
        done = self.call("--logs", path, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("gauge_1_V", done.stdout)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["a.csv"])

    def test_a_log_can_be_gzipped(self):
        path = self.write("a.csv", LOG)
        for name in ("b.csv", "b.csv.gz"):
            self.assertEqual(self.call("--logs", path, "--out", self.folder / name).returncode, 0)
        self.assertEqual(gzip.decompress((self.folder / "b.csv.gz").read_bytes()),
                         (self.folder / "b.csv").read_bytes())
        self.assertEqual({p.name for p in self.folder.iterdir()},
                         {"a.csv", "b.csv", "b.csv.gz", "b.mapping.yaml"})

    def test_a_folder_that_is_absent_is_one_line(self):
        path = self.write("a.csv", LOG)
        done = self.call("--logs", path, "--out", self.folder / "none/log.csv")
        self.assertEqual((done.returncode, done.stderr.count("cannot be written")), (2, 1))

    def test_a_symbolic_link_beside_the_executables_finds_the_package(self):
        link = self.folder / "finray_import"
        link.symlink_to(TOOL)
        done = subprocess.run([link, "--version"], capture_output=True, text=True, cwd="/")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^finray_import version \d+\.\d+\.\d+\S*\n(\S+ \S+\n)*$")
        self.assertIn("\nnumpy ", done.stdout)

    def test_the_locale_does_not_matter(self):
        path = self.write("a.csv", LOG)
        for locale in ("C", "de_DE.UTF-8"):
            done = self.call("--logs", path, "--out", self.folder / f"{locale}.csv",
                             env={**os.environ, "LC_ALL": locale})
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "C.csv").read_bytes(),
                         (self.folder / "de_DE.UTF-8.csv").read_bytes())

    def test_an_input_is_not_written_over(self):
        path, mapping = self.write("a.csv", LOG), self.write("b.mapping.yaml", "tables: {}\n")
        link = self.folder / "link.csv"
        link.symlink_to(path)
        for out in ("a.csv", "./a.csv", "link.csv", "b.csv"):
            with self.subTest(out):
                done = self.call("--logs", path, "--mapping", mapping, "--out", out, cwd=self.folder)
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1))
                self.assertIn("is an input and would be written over", done.stderr)
        self.assertEqual((path.read_text(), mapping.read_text()), (LOG, "tables: {}\n"))

    def test_a_folder_as_output_leaves_nothing(self):
        path = self.write("a.csv", LOG)
        (self.folder / "d").mkdir()
        done = self.call("--logs", path, "--out", self.folder / "d")
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("d: is a folder")), (2, "", 1))
        self.assertEqual({p.name for p in self.folder.iterdir()}, {"a.csv", "d"})

    def test_what_is_printed_and_arrives_nowhere_is_exit_2(self):
        path = self.write("a.csv", LOG)
        read, broken = os.pipe()
        os.close(read)
        outputs = {"Broken pipe": broken, "No space left on device": os.open("/dev/full", os.O_WRONLY), "is closed": None}
        for name, arguments in (("finray_import", ["--version"]), ("finray_import", ["--help"]),
                                ("finray_import", ["--logs", path]), ("finray_convert", ["--help"])):
            for why, output in outputs.items():
                with self.subTest(f"{name} {arguments} {why}"):
                    done = subprocess.run([ROOT / "apps" / name, *map(str, arguments)], stdout=output,
                                          stderr=subprocess.PIPE, text=True,
                                          preexec_fn=None if output else lambda: os.close(1))
                    self.assertEqual((done.returncode, done.stderr), (2, f"{name}: stdout: {why}\n"))

    def test_two_files_of_one_name_are_refused(self):
        (self.folder / "b").mkdir()
        a, b = self.write("a.csv", LOG), self.write("b/a.csv", LOG)
        self.assertIn("two tables are named", self.refused("--logs", f"{a},{b}"))

    def test_sources_are_small(self):
        for path in pathlib.Path(import_log.__file__).parent.glob("*.py"):
            self.assertLess(len(path.read_text().splitlines()), 400, path)

    def test_names_from_files_are_one_line_without_control_characters(self):
        """Of files, columns and tables, in what is printed and in what is refused."""
        rows = "".join(f"{0.01 * i},{0.1 * i},1\n" for i in range(9))
        for name in ("a\nx.csv", "e\x1b[31mq.csv", "b\u202ec.csv"):
            with self.subTest(name):
                path = self.write(name, f"time_s,gauge_1_V,odd\x1b[31m\n{rows}")
                done = self.call("--logs", path, "--out", self.folder / "log.csv")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(re.sub(r"[^ -~]", "?", name), done.stdout)
                self.assertEqual(re.sub(r"[\n -~]", "", done.stdout + done.stderr), "")
                self.assertEqual(done.stdout.count("\n"), 8, done.stdout)
                done = self.call("--logs", self.folder / f"none{name}")
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
                self.assertEqual(re.sub(r"[\n -~]", "", done.stderr), "")

    def test_flags_and_mapping_have_one_rule(self):
        path = self.write("a.csv", LOG)
        for flag, key, value in (("longest_gap_s", "join: {longest_gap_s: ", "-1"), ("longest_gap_s", "join: {longest_gap_s: ", "0"),
                                 ("shortest_plateau_s", "plateaus: {shortest_s: ", "1e-300"),
                                 ("shortest_plateau_s", "plateaus: {shortest_s: ", "1e9")):
            with self.subTest(f"{flag} {value}"):
                more = ["--plateaus"] if "plateau" in flag else []
                expected = self.refused("--logs", path, f"--{flag}", value, *more, code=1)
                expected = expected[expected.index("expected"):expected.index(", found")]
                line = self.refused("--logs", path, "--mapping", self.write("m.yaml", f"{key}{value}}}\n"))
                self.assertIn(f"{expected}, found '", line)
        for text, words in (("tables: {a.csv: {time_offset_s: 1e12}}\n", "time_offset_s: expected"),
                            ("force: {free_s: [2, 1]}\n", "free_s: expected [first, last]")):
            self.assertIn(words, self.refused("--logs", path, "--mapping", self.write("m.yaml", text)))

    def test_keys_of_a_mapping_without_a_value_name_their_place(self):
        path = self.write("a.csv", LOG)
        for text, where in (("columns:\n", "1:9: columns"), ("columns: {g: {to: }}\n", "1:18: to"),
                            ("columns: {g: {to: gauge_1_V, unit: }}\n", "1:35: unit"),
                            ("tables: {a.csv: {columns: }}\n", "1:26: columns"),
                            ("columns: {g: {to: gauge_1_V, scale: }}\n", "1:36: scale"), ("row_type:\n", "1:10: row_type"),
                            ("columns: {? [a] : gauge_1_V}\n", "1:13: expected a word as a key")):
            with self.subTest(text):
                line = self.refused("--logs", path, "--mapping", self.write("m.yaml", text))
                self.assertIn(f"m.yaml:{where}", line)
                self.assertTrue("found nothing" in line or "as a key" in line, line)
                self.assertEqual("expected a mapping (header: column), or the name of a YAML file" in line,
                                 where.endswith("columns"))


if __name__ == "__main__":
    unittest.main()

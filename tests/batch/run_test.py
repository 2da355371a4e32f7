#!/usr/bin/python3
"""scripts/batch/run on this machine."""

import csv
import os
import shutil
import subprocess
import unittest
import unittest.mock

import batch_fixture
from batch_fixture import FRAMES
import batch_config
import log_files

LOGS = ["d1/a.csv", "d1/b.csv", "d1/c.csv", "d2/a.csv", "d2/b.csv", "d3/a.csv"]
GROUP_SUMMARY = "groups/*/*/summary.yaml"


class RunTest(batch_fixture.BatchTestCase):
    def test_gives_what_one_run_over_all_logs_gives(self):
        self.write_logs(LOGS)
        # One has no reference force.
        path = self.folder / "runs" / LOGS[1]
        path.write_text(path.read_text().replace("force_N", "other"))
        output = self.run_batch("--logs_per_task", "4", "--jobs", "2")
        self.assertIn("in 6 logs, 2 groups", output)
        self.expect_equal_to_single()
        before = self.times("[!.]*/**/*")
        self.run_batch("--logs_per_task", "4")
        self.assertEqual(self.changed("[!.]*/**/*", before), [])

    def test_ends_with_the_warnings(self):
        self.write_logs(LOGS[:3])
        for name in LOGS[1:3]:
            path = self.folder / "runs" / name
            head, *rows = path.read_text().splitlines()
            cells = [row.split(",") for row in rows]
            path.write_text("\n".join([head] + [",".join(
                [row[0], repr(float(row[1]) + 0.5), *row[2:]]) for row in cells]) + "\n")
        output = self.run_batch("--logs_per_task", "2")
        self.assertIn("\nwarning: the finger is not calibrated: ", output)
        self.assertRegex(output, r"\nwarning: .* solved frames of \S*d1/b.csv are not .*"
                         r"\(and 1 more such log\); calibrate it")
        self.expect_equal_to_single()

    def test_does_again_what_depends_on_a_change(self):
        self.write_logs(LOGS)
        self.run_batch("--logs_per_task", "4")

        summaries, frames = self.times(GROUP_SUMMARY), self.times(FRAMES)
        batch_fixture.write_log(self.folder / "runs/d2/b.csv", 30, 5)
        batch_fixture.write_log(self.folder / "runs/d1/d.csv", 14, 5)
        self.run_batch("--logs_per_task", "4")
        self.assertEqual(self.changed(GROUP_SUMMARY, summaries),
                         ["groups/000/001/summary.yaml"])
        self.assertEqual(self.changed(FRAMES, frames),
                         ["groups/000/001/d1/d.frames.csv",
                          "groups/000/001/d2/b.frames.csv"])
        self.expect_equal_to_single()

        frames = self.times(FRAMES)
        self.finger.write_text(self.finger.read_text() + "\n# new\n")
        self.run_batch("--logs_per_task", "4")
        self.assertEqual(self.changed(FRAMES, frames), sorted(frames))

        (self.folder / "runs/d1/a.csv").unlink()
        self.run_batch("--logs_per_task", "4")
        self.expect_equal_to_single()

    def test_bad_logs_are_left_out_and_listed(self):
        self.write_logs(LOGS)
        bad = [self.folder / "runs" / name for name in ("d1/c.csv", "d3/a.csv")]
        good = [path.read_text() for path in bad]
        for path, text in zip(bad, good):
            path.write_text(text + "1,x,0,0,0,0,0,0\n")
        # Groups of one, so that one is left without a log.
        for size in ("1", "4"):
            out = "out" + size
            output = self.run_batch("--logs_per_task", size, code=2, out=out)
            self.assertRegex(output, r"in 4 logs, .*\n(.*\n)*run: .*d1/c.csv:16:2: .*\n"
                             r"run: .*d3/a.csv:19:2: .*\nrun: 2 logs left out")
            self.expect_equal_to_single(self.folder / out, code=2)
        for path, text in zip(bad, good):
            path.write_text(text)
        self.run_batch("--logs_per_task", "4", out="out4")
        self.expect_equal_to_single(self.folder / "out4")

    def test_bad_log_is_tried_again(self):
        self.write_logs(LOGS[:3])
        path = self.folder / "runs" / LOGS[1]
        good, time = path.read_text(), path.stat().st_mtime_ns
        head, row, rest = good.split("\n", 2)
        path.write_text("\n".join([head, "x" + row[1:], rest]))
        self.run_batch(code=2)
        # Of the same size and time, as where only the rights to read it changed.
        path.write_text(good)
        os.utime(path, ns=(time, time))
        frames = self.times(FRAMES)
        self.run_batch()
        self.assertEqual(self.changed(FRAMES, frames),
                         ["groups/000/000/b.frames.csv"])
        self.expect_equal_to_single()

    def test_says_why_a_merge_failed(self):
        self.write_logs(LOGS)
        self.run_batch("--logs_per_task", "4")
        merged = (self.out / "summary.csv").read_bytes()
        # The overall summary cannot be written.
        (self.out / "summary.csv").unlink()
        (self.out / "summary.csv.new").mkdir()
        self.assertIn("run: all groups are done, but the overall summary cannot be "
                      f"written: {self.out}/summary.csv.new: Is a directory\n",
                      self.run_batch("--logs_per_task", "4", code=1))
        (self.out / "summary.csv.new").rmdir()
        # A group's is not what finray_estimate has written.
        path = self.out / "groups/000/001/summary.csv"
        good = path.read_text()
        path.write_text(good.replace(",13,", ",many,").replace(",16,", ",many,"))
        self.assertIn("run: groups/000/001/summary.csv: the row of '",
                      self.run_batch("--logs_per_task", "4", code=2))
        path.write_text(good + good.splitlines(keepends=True)[1])
        self.assertIn("summary.yaml: expected the logs of summary.csv",
                      self.run_batch("--logs_per_task", "4", code=2))
        path.write_text(good)
        self.run_batch("--logs_per_task", "4")
        self.assertEqual((self.out / "summary.csv").read_bytes(), merged)


    def test_writes_what_is_asked_for_and_lists_bad_rows(self):
        self.write_logs(LOGS)
        for name in LOGS[1:3]:
            path = self.folder / "runs" / name
            path.write_text(path.read_text() + "1,x,0,0,0,0,0,0\n2,3\n")
        more = ("--bad_rows", "skip", "--digits", "6", "--columns",
                "time_s,contact_1_*,normal_1_N,status")
        output = self.run_batch("--logs_per_task", "2", *more, logs="runs/**")
        self.assertRegex(output, r"\nwarning: 2 of 15 rows of \S*d1/b.csv are bad .*"
                         r"\(and 1 more such log\)")
        self.expect_equal_to_single(more=more)
        head, first, *_ = (self.out / "groups/000/000/a.frames.csv").read_text().splitlines()
        self.assertTrue(head.startswith("time_s,contact_1_mm,contact_1_std_mm,"))
        self.assertTrue(head.endswith(",normal_1_N,status"))
        self.assertEqual(first.split(",")[0], "0.000000")  # as it is in the log
        bad = (self.out / "groups/000/000/b.bad_rows.csv").read_text()
        self.assertIn("b.csv:15:2: gauge_1_V: expected a number, found 'x'", bad)
        self.assertIn("b.csv:16: expected 8 cells as in the header, found 2", bad)
        self.assertEqual([row["bad_rows"] for row in self.rows(self.out)],
                         ["0", "2", "2", "0", "0", "0"])

    def test_takes_the_mapping_along(self):
        self.write_logs(LOGS[:1])
        path = self.folder / "runs" / LOGS[0]
        text = path.read_text()
        self.run_batch(out="plain")
        path.write_text(text.replace("gauge_1_V", "U1").replace(",", ";").replace(".", ","))
        (self.folder / "lab").mkdir()
        (self.folder / "lab/columns.yaml").write_text("columns: {U1: gauge_1_V}\n")
        scene = self.folder / "scene.yaml"
        scene.write_text("contacts: auto\ncolumns: lab/columns.yaml\n")
        self.run_batch("--scene", "scene.yaml")
        results = [list(csv.DictReader((self.folder / out / "groups/000/000/a.frames.csv")
                                       .read_text().splitlines()))
                   for out in ("plain", "out")]
        for row, other in zip(*results):
            for name, cell in row.items():
                self.assertEqual(cell if name == "status" else float(cell or "nan"),
                                 other[name] if name == "status"
                                 else unittest.mock.ANY if cell == ""
                                 else float(other[name]))
        frames = self.times(FRAMES)
        (self.folder / "lab/columns.yaml").write_text(
            "columns: {U1: {to: gauge_1_V, offset: 0.001}}\n")
        self.run_batch("--scene", "scene.yaml")
        self.assertEqual(self.changed(FRAMES, frames), sorted(frames))

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_on_a_few_machines(self):
        self.write_logs(LOGS)
        ssh = self.folder / "ssh"

        def stand_in(shell):
            """sshd sets SHELL; a task without a shell ends without a word."""
            ssh.write_text("#!/bin/bash\n"
                           f"echo $1 >>{self.folder}/hosts\nshift\n"
                           "[[ $1 == -- ]] && shift\n"
                           f'SHELL={shell} exec bash -c "$*"\n')
            ssh.chmod(0o755)

        machines = {"env": {**os.environ, "PARALLEL_SSH": str(ssh)}}
        stand_in("")
        output = self.run_batch("--logs_per_task", "1", "--machines", "2/one,1/two",
                                code=1, **machines)
        self.assertIn("ended before finray_estimate began", output)
        stand_in("/bin/bash")
        self.run_batch("--logs_per_task", "1", "--machines", "2/one,1/two", **machines)
        hosts = set((self.folder / "hosts").read_text().split())
        self.assertEqual(hosts, {"one", "two"})
        self.expect_equal_to_single()
        output = self.run_batch("--slurm", "--machines", "one", code=1)
        self.assertIn("--slurm and --machines do not go together", output)


class LogFilesTest(batch_fixture.BatchTestCase):
    """The logs of an item, by Python and by finray_estimate."""

    def test_folders_and_patterns(self):
        self.write_logs(["a.csv", "b.csv.txt", "d1/c.csv", "d1/e/f.csv", ".hidden/g.csv",
                         "d2/a.csv"], frames=1)
        (self.folder / "runs/link").symlink_to(self.folder / "runs/d1")
        runs = str(self.folder / "runs")
        for item, expected in (
                (runs, ["a.csv"]), (runs + "/d1/", ["d1/c.csv"]),
                (runs + "/**", ["a.csv", "d1/c.csv", "d1/e/f.csv", "d2/a.csv"]),
                (runs + "/**/a.csv", ["a.csv", "d2/a.csv"]),
                (runs + "/d*/**/*.csv", ["d1/c.csv", "d1/e/f.csv", "d2/a.csv"]),
                (runs + "/**/e/**", ["d1/e/f.csv"])):
            paths = [os.path.join(runs, name) for name in expected]
            self.assertEqual([os.path.normpath(path) for path in
                              log_files.expand([item], str(self.out))], paths)
            done = subprocess.run(
                [batch_fixture.ESTIMATE, "--finger", self.finger, "--logs", item,
                 "--logs_root", runs, "--out_dir", "out"], cwd=self.folder,
                check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.assertIn(done.returncode, (0, 3))
            self.assertEqual([os.path.normpath(row["log"])
                              for row in self.rows(self.out)], paths)
        for item, text in ((runs + "/none*", "matches no file"),
                           (str(self.out / ".."), "logs in its folders are")):
            with self.assertRaisesRegex(batch_config.BadInput, text):
                log_files.expand([item], "/none")


class BadInputTest(batch_fixture.BatchTestCase):
    def expect_line(self, text, *more, code=2, **arguments):
        output = self.run_batch(*more, code=code, **arguments)
        self.assertIn(text, output)
        self.assertEqual(output.count("\n"), 1, output)

    def test_says_what_is_wrong_in_one_line(self):
        self.write_logs(LOGS[:1])
        config = self.folder / "c.yaml"
        config.write_text("log_per_task: 3\n")
        self.expect_line("c.yaml: unknown key 'log_per_task'; did you mean "
                         "'logs_per_task'?", "--config", "c.yaml")
        config.write_text("cpus_per_task: many\n")
        self.expect_line("c.yaml: cpus_per_task: expected a whole number, not 'many'",
                         "--config", "c.yaml")
        config.write_text("logs_per_task: 0\n")
        self.expect_line("logs_per_task: expected at least 1", "--config", "c.yaml")
        config.write_bytes(b"minutes: 3\nscene: \xff\n")
        self.expect_line("c.yaml:2:8: expected text in UTF-8", "--config", "c.yaml")
        config.write_bytes(b"minutes: 3\nscene: a\x07\n")
        self.expect_line("c.yaml:2:9: character 0x7 is not allowed in YAML",
                         "--config", "c.yaml")
        config.write_text("minutes: [3\n")
        self.expect_line("c.yaml:2:1: ", "--config", "c.yaml")
        config.write_text("minutes: 3\n\tcpus_per_task: 1\n")
        self.expect_line("c.yaml:2:1: tab in the indentation, YAML wants spaces",
                         "--config", "c.yaml")
        self.expect_line("'--job' is not a flag", "--job", "2", code=1)
        self.expect_line("--scheme: expected one of taylor, rigid_chain",
                         "--scheme", "linear")
        self.expect_line("runs/*.tsv' matches no file", logs="runs/*.tsv")
        self.finger.write_text("schema_version: 1\nname: x\n")
        self.expect_line("finger.yaml")
        self.assertEqual(list(self.out.glob("groups/*")), [])

    def test_names_the_package_of_snakemake(self):
        self.write_logs(LOGS[:1])
        self.expect_line("snakemake is not installed; the Debian package is snakemake",
                         code=1, env={"PATH": str(self.folder)})


if __name__ == "__main__":
    batch_fixture.main()

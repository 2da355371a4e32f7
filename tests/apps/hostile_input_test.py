#!/usr/bin/python3
"""Hostile files through the command line: exit code 2 and one line that names the
file, within seconds and bounded memory, and nothing written."""

import gzip
import os
import re
import shutil
import subprocess
import sys
import threading
import time
import unittest

sys.dont_write_bytecode = True
from good_inputs import APPS, FINGER, LOADS, LOG  # noqa: E402
from hostile import BINARIES, BOUNDED, HostileCase, SECONDS  # noqa: E402


def cell(value):
    """The second cell of the first row replaced."""
    def change(text):
        rows = text.split(b"\n")
        cells = rows[1].split(b",")
        cells[1] = value
        rows[1] = b",".join(cells)
        return b"\n".join(rows)
    return change


# Tables of readings whose second column is a gauge.
GAUGES = [("estimate", "log.csv"), ("compliance", "log.csv"), ("reconstruct", "log.csv"),
          ("view", "a.frames.csv")]


def numbers(value):
    """All numbers of a YAML replaced but for its schema_version."""
    number = rb"(?<=[:\[,] )-?[0-9][0-9.e+-]*(?=[,}\]\n])|(?<=\[)-?[0-9.]+(?=[,\]])"
    def change(text):
        lines = text.split(b"\n")
        return b"\n".join(line if b"schema_version" in line
                          else re.sub(number, value, line) for line in lines)
    return change


def laughs(key):
    """9^9 words behind few bytes."""
    lines = [b"l0: &l0 [x, x, x, x, x, x, x, x, x]"]
    lines += [b"l%d: &l%d [%s]" % (i, i, b", ".join([b"*l%d" % (i - 1)] * 9))
              for i in range(1, 9)]
    return b"\n".join(lines) + b"\n" + key + b": *l8\n"


def nul(text):
    return text[:len(text) // 2] + b"\0" + text[len(text) // 2:]


BAD_CSV = {
    "NUL": nul,
    "UTF-16": lambda text: text.decode().encode("utf-16"),
    "carriage returns only": lambda text: text.replace(b"\n", b"\r"),
    "a line of 40 MB": lambda text: text + b"1" * 40_000_000,
    "20 million cells": lambda text: text + b"1," * 20_000_000,
    "empty": lambda text: b"",
    "header only": lambda text: text.split(b"\n")[0] + b"\n",
    "decimal commas": lambda text: text.replace(b".", b","),
    "thousands or decimals": lambda text: cell(b"1_234")(text).replace(b",", b";")
                             .replace(b";1_234", b";1,234"),
    "hexadecimal": cell(b"0x1p3"),
    "1e999": cell(b"1e999"),
    "infinite": cell(b"inf"),
    "open quote": cell(b'"1'),
    "a column twice": lambda text: text.split(b",")[0] + b"," + text,
    "bytes": lambda text: bytes(i * 7919 >> 3 & 255 for i in range(5000)),
    "gzip cut short": lambda text: gzip.compress(text)[:-12],
    "gzip of 200 MB in a line": lambda text: gzip.compress(text + b"7" * 200_000_000, 1),
}
BAD_YAML = {
    "NUL": nul,
    "UTF-16": lambda text: text.decode().encode("utf-16"),
    "tabs": lambda text: text.replace(b"\n", b"\n\t"),
    "empty": lambda text: b"",
    "a list": lambda text: b"- 1\n",
    "a comma, which the parser never gets past": lambda text: b"," + text,
    "lists in lists": lambda text: text + b"z: " + b"[" * 100_000,
    "closed lists in lists": lambda text: text + b"z: " + b"[" * 300 + b"]" * 300,
    "block lists": lambda text: text + b"z: " + b"- " * 20_000 + b"\n",
    "billion laughs": lambda text: text + laughs(b"z"),
    "inside itself": lambda text: text + b"z: &z [*z]\n",
    "no such anchor": lambda text: text + b"z: *nothing\n",
    "20 MB": lambda text: text + b"z: " + b"x" * 20_000_000 + b"\n",
    "a key twice": lambda text: text + re.search(rb"^\w+:", text, re.M)[0] + b" 1\n",
    "control characters in YAML's version": lambda text: b"%YAML 9\x07.\r\n---\n" + text,
    "hexadecimal": numbers(b"0x10"),
    "1e999": numbers(b"1e999"),
    "1e308": numbers(b"1e308"),
    "not a number": numbers(b".nan"),
    "infinite": numbers(b".inf"),
}


class HostileInputTest(HostileCase):
    def refuse_all(self, ending, kinds, but=()):
        for app, (files, _) in APPS.items():
            for name in files:
                if not name.endswith(ending):
                    continue
                for kind, change in kinds.items():
                    if (app, name, kind) in but:
                        continue
                    bad = change(files[name])
                    # Decimal points are not in all files.
                    if bad == files[name]:
                        continue
                    with self.subTest(app=app, file=name, kind=kind):
                        arguments = self.put(app)
                        (self.folder / name).write_bytes(bad)
                        self.expect_refused(app, arguments, name)

    def test_tables(self):
        # A gauge with an open cable makes a bad row, not a bad file.
        but = {(app, name, kind) for app, name in GAUGES for kind in ("1e999", "infinite")}
        self.refuse_all(".csv", BAD_CSV, but)

    def test_an_infinite_reading_is_a_bad_row(self):
        for app, name in GAUGES:
            for kind in ("1e999", "infinite"):
                with self.subTest(app=app, kind=kind):
                    arguments = self.put(app)
                    (self.folder / name).write_bytes(BAD_CSV[kind](APPS[app][0][name]))
                    outcome = self.run_app(app, arguments)
                    self.assertEqual(outcome.returncode, 0, outcome.stderr[-500:])
                    if app == "estimate":
                        self.assertIn(b"0 not_converged, 1 bad_input", outcome.stdout)
                        self.assertIn(b"warning: 1 of 5 rows of log.csv are bad_input for a reading that no gauge gives: "
                                      b"in row 1 gauge 1 reads inf V, expected -6.283 to 6.283 V; ", outcome.stderr)

    def test_yaml(self):
        self.refuse_all(".yaml", BAD_YAML)

    def test_what_is_no_file(self):
        def absent(path):
            path.unlink()

        def folder(path):
            path.unlink()
            path.mkdir()

        def pipe(path):
            path.unlink()
            os.mkfifo(path)

        def endless(path):
            path.unlink()
            path.symlink_to("/dev/zero")

        def unreadable(path):
            path.chmod(0)

        kinds = [absent, folder, pipe, endless]
        if os.geteuid() != 0:  # root reads all
            kinds.append(unreadable)
        for app, (files, _) in APPS.items():
            for name in files:
                for make in kinds:
                    with self.subTest(app=app, file=name, kind=make.__name__):
                        arguments = self.put(app)
                        make(self.folder / name)
                        self.expect_refused(app, arguments, name)

    def test_numbers_that_nothing_measures(self):
        """Places and loads far from what a finger can bear."""
        for header in ("object_x_mm,object_y_mm", "object_y_mm,object_x_mm", "contact_1_mm,normal_1_N",
                       "normal_1_N,contact_1_mm", "friction_1,contact_1_mm,normal_1_N",
                       "object_angle_deg,object_x_mm,object_y_mm"):
            for value in ("1e18", "-1e18", "1e155", "1e300"):
                with self.subTest(header=header, value=value):
                    arguments = self.put("simulate")
                    row = ",".join([value, "20", "1"][:header.count(",") + 1])
                    (self.folder / "in.csv").write_text(f"{header}\n{row}\n")
                    self.assertIn(header.split(",")[0], self.expect_refused("simulate", arguments, "in.csv"))

    def test_fingers_that_nobody_makes(self):
        ribs = b"ribs:\n" + b"".join(b"  - {front_mm: %g, back_mm: %g}\n" % (i * 1.3e-3, i * 1.4e-3)
                                     for i in range(1, 100001))
        cases = {"ribs": re.sub(rb"ribs:\n(  - .*\n)+", ribs, FINGER),
                 "beams": FINGER.replace(b"12500", b"1e-3", 1),
                 "front_length_mm": FINGER.replace(b"front_length_mm: 140", b"front_length_mm: 1e20")}
        for key, finger in cases.items():
            self.assertNotEqual(finger, FINGER)
            for app in ("simulate", "estimate", "calibrate"):
                with self.subTest(key=key, app=app):
                    arguments = self.put(app)
                    (self.folder / "finger.yaml").write_bytes(finger)
                    self.assertIn(key, self.expect_refused(app, arguments, "finger.yaml"))

    def test_forces_with_the_other_sign(self):
        arguments = self.put("calibrate")
        rows = [line.split(b",") for line in LOG.splitlines()]
        at = rows[0].index(b"force_N")
        for row in rows[1:]:
            row[at] = b"-2.5"
        (self.folder / "log.csv").write_bytes(b"\n".join(map(b",".join, rows)) + b"\n")
        line = self.expect_refused("calibrate", arguments, "log.csv:2: force_N")
        self.assertIn("scale: -1", line)

    def test_a_small_file_that_unpacks_to_gigabytes(self):
        zeros = b"0,0,0,0\n" * (1 << 20)
        packed = gzip.compress(b"gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n") + gzip.compress(zeros) * 100
        for app, flag in (("estimate", "log.csv"), ("calibrate", "log.csv"), ("simulate", "in.csv")):
            with self.subTest(app=app):
                arguments = self.put(app)
                (self.folder / flag).write_bytes(packed)
                self.assertIn("unpacks to more than", self.expect_refused(app, arguments, flag))

    @unittest.skipUnless(BOUNDED, "sanitizers reserve terabytes")
    def test_memory_that_does_not_suffice(self):
        arguments = self.put("simulate")
        (self.folder / "in.csv").write_bytes(LOADS + b"60.5,1\n" * 2_000_000)
        outcome = subprocess.run(["sh", "-c", f'ulimit -v 200000; "$0"/finray_simulate {arguments}', BINARIES],
                                 cwd=self.folder, stderr=subprocess.PIPE, timeout=SECONDS, check=False)
        self.assertEqual((outcome.returncode, outcome.stderr),
                         (2, b"finray_simulate: the memory does not suffice for this input\n"))

    def test_kinds_of_text_that_are_fine(self):
        changes = (lambda text: b"\xef\xbb\xbf" + text,
                   lambda text: text.replace(b"\n", b"\r\n"))
        for change in changes:
            outputs = []
            for modify in (lambda text: text, change):
                arguments = self.put("estimate")
                for name in APPS["estimate"][0]:
                    path = self.folder / name
                    path.write_bytes(modify(path.read_bytes()))
                outcome = self.run_app("estimate", arguments)
                self.assertEqual(outcome.returncode, 0, outcome.stderr)
                outputs.append((self.folder / "out/log.frames.csv").read_bytes())
                shutil.rmtree(self.folder / "out")
            self.assertEqual(*outputs)

    def test_a_log_that_is_cut_while_it_is_read(self):
        arguments = self.put("estimate")
        # Nothing to search for: the time should be that of reading.
        (self.folder / "scene.yaml").write_bytes(b"contacts: 0\n")
        log = self.folder / "log.csv"
        header, *rows = LOG.splitlines(keepends=True)
        log.write_bytes(header + b"".join(rows) * 200_000)

        def cut():
            # Once its rows are being written.
            end = time.monotonic() + SECONDS
            while not list(self.folder.glob("out/.*.part")) and time.monotonic() < end:
                time.sleep(1e-3)
            os.truncate(log, len(header) + 100)

        cutter = threading.Thread(target=cut)
        cutter.start()
        outcome = self.run_app("estimate", arguments)
        cutter.join()
        self.assertEqual(outcome.returncode, 2, outcome.stderr)
        self.assertIn(b"was changed while it was being read", outcome.stderr)
        self.assertEqual(list((self.folder / "out").iterdir()), [])

    def test_rows_of_a_pipe_without_end(self):
        """10 GB would be the same: reading ends at the limit of a line."""
        self.put("estimate")
        with open("/dev/zero", "rb") as zeros:
            outcome = self.run_app("estimate", "--follow --finger finger.yaml", stdin=zeros)
        self.assertEqual(outcome.returncode, 2, outcome.stderr[:500])
        self.assertEqual(outcome.stderr, b"finray_estimate: stdin:1: the line is too long "
                                         b"for a table of numbers\n")

    # Whoever hashes or reads all of it takes minutes.
    def test_a_sparse_line_of_100_GB(self):
        for app, name in (("simulate", "in.csv"), ("estimate", "log.csv")):
            with self.subTest(app=app):
                arguments = self.put(app)
                os.truncate(self.folder / name, 100 << 30)
                line = self.expect_refused(app, arguments, name)
                self.assertIn("too long for a table of numbers", line)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""Hostile files through the command line: exit code 2 and one line that names the
file, within seconds and bounded memory, and nothing written."""

import functools
import gzip
import os
import pathlib
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.parse

import yaml

sys.dont_write_bytecode = True
from good_inputs import APPS, FINGER, LOADS, LOG  # noqa: E402

BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ".")).resolve()
USER_LOCALE = BINARIES / "tests/libuser_locale.so"
# Sanitizers reserve terabytes of addresses.
BOUNDED = os.environ.get("FINRAY_SANITIZE", "") == ""
MEMORY = 1 << 30  # bytes of addresses
SECONDS = 60       # a hang, on a busy machine too


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


class HostileInputTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="finray_hostile_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def put(self, app):
        """The good files, nothing else; returns the arguments."""
        files, arguments = APPS[app]
        out = self.folder / "out"
        if out.is_dir():
            shutil.rmtree(out)
        else:
            out.unlink(missing_ok=True)
        for name, content in files.items():
            path = self.folder / name
            if path.is_dir():
                path.rmdir()
            else:
                path.unlink(missing_ok=True)
            path.write_bytes(content)
        return arguments

    def run_app(self, app, arguments, **more):
        def bound():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        return subprocess.run(
            [BINARIES / f"finray_{app}", *arguments.split()], cwd=self.folder,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=SECONDS, check=False,
            preexec_fn=bound if BOUNDED else None, **more)

    def expect_refused(self, app, arguments, name, **more):
        """One line on stderr, about the file `name`; returns it."""
        outcome = self.run_app(app, arguments, **more)
        line = outcome.stderr.decode(errors="replace")
        self.assertEqual(outcome.returncode, 2, line[:500])
        self.assertEqual(line.count("\n"), 1, line[:500])
        self.assertTrue(line.startswith(f"finray_{app}: {name}"), line[:500])
        self.assertLess(len(line), 1300)
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual(list(self.folder.glob(".*")), [])
        return line

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

    def test_output_that_nobody_takes(self):
        """--help, --version, --dump_config and a summary: exit code 2 and a line, also where stdout is closed."""
        self.put("estimate")
        commands = ["check --finger finger.yaml", "estimate --help", "simulate --version", "check -h",
                    "estimate --dump_config --finger finger.yaml --logs log.csv --out_dir out"]
        for command in commands:
            for target, reason in (("> /dev/full", b"No space left on device"), (">&-", b"Bad file descriptor")):
                with self.subTest(command=command, target=target):
                    outcome = subprocess.run(["sh", "-c", f'"$0"/finray_{command} {target}', BINARIES], cwd=self.folder,
                                             stderr=subprocess.PIPE, timeout=SECONDS, check=False)
                    self.assertEqual(outcome.returncode, 2)
                    self.assertTrue(outcome.stderr.endswith(b": standard output: cannot be written: " + reason + b"\n"),
                                    outcome.stderr)

    def test_no_output_goes_where_stdout_was(self):
        arguments = self.put("simulate")
        outcome = subprocess.run(["sh", "-c", f'"$0"/finray_simulate {arguments} >&-', BINARIES], cwd=self.folder,
                                 stderr=subprocess.PIPE, timeout=SECONDS, check=False)
        self.assertEqual(outcome.returncode, 2)
        self.assertNotIn(b"with contact", (self.folder / "out").read_bytes())

    @unittest.skipUnless(BOUNDED, "sanitizers reserve terabytes")
    def test_memory_that_does_not_suffice(self):
        arguments = self.put("simulate")
        (self.folder / "in.csv").write_bytes(LOADS + b"60.5,1\n" * 2_000_000)
        outcome = subprocess.run(["sh", "-c", f'ulimit -v 200000; "$0"/finray_simulate {arguments}', BINARIES],
                                 cwd=self.folder, stderr=subprocess.PIPE, timeout=SECONDS, check=False)
        self.assertEqual((outcome.returncode, outcome.stderr),
                         (2, b"finray_simulate: the memory does not suffice for this input\n"))

    def test_names_of_logs(self):
        """Summaries and pages are UTF-8, and finray reads them again."""
        self.put("estimate")
        names = [b"a\nb", b"a\x01b", b"caf\xe9 %41", b"a#b?c", "caf\u00e9".encode()]
        (self.folder / "runs").mkdir()
        for name in names:
            with open(os.fsencode(self.folder) + b"/runs/" + name + b".csv", "wb") as log:
                log.write(LOG)
        outcome = self.run_app("estimate", "--finger finger.yaml --logs runs --out_dir out --report")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        outcome.stderr.decode()  # no other bytes
        summary = yaml.safe_load((self.folder / "out/summary.yaml").read_text("utf-8"))
        self.assertIn("runs/a\nb.csv", [log["log"] for log in summary["logs"]])
        self.assertIn("runs/caf%E9 %2541.csv", [log["log"] for log in summary["logs"]])
        for page in self.folder.glob("out/*.html"):
            page.read_text("utf-8")
        pages = re.findall(r'"page":"([^"]*)"', (self.folder / "out/index.html").read_text("utf-8"))
        self.assertEqual({urllib.parse.unquote_to_bytes(page) for page in pages}, {name + b".html" for name in names})
        outcome = self.run_app("view", "--finger finger.yaml --results out --out_dir pages")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)

    def test_plots_on_a_full_disk(self):
        """Each file is whole under its name, or there is none, and the exit code says so."""
        for app in ("compliance", "reconstruct"):
            with self.subTest(app=app):
                arguments = self.put(app).replace(" --noplots", "")
                program = shlex.quote(str(BINARIES / f"finray_{app}"))
                files = {}
                for size in ("100m", "400k"):
                    outcome = self.on_small_disk(size, f"""head -c {380 if size == "400k" else 0}k /dev/zero > out/other
                        {program} {arguments}; code=$?; rm -rf kept; cp -r out kept; exit $code""")
                    found = {p.name: p.read_bytes() for p in self.folder.glob("kept/*.[sp][vn]g")}
                    files[size] = found
                    if size == "100m":
                        self.assertEqual((outcome.returncode, len(found)), (0, 2), outcome.stderr)
                self.assertEqual(outcome.returncode, 2, outcome.stderr)
                self.assertIn(b"cannot be written: No space left on device\n", outcome.stderr)
                self.assertNotIn(b"Traceback", outcome.stderr)
                self.assertEqual({**files["100m"], **files["400k"]}, files["100m"])

    def test_links_in_the_place_of_outputs(self):
        for app in ("simulate", "estimate", "calibrate", "compliance"):
            arguments = self.put(app).replace("--out out", "--out out/result.csv")
            (self.folder / "out").mkdir()
            self.run_app(app, arguments)
            written = [path.name for path in (self.folder / "out").iterdir()]
            shutil.rmtree(self.folder / "out")
            (self.folder / "out").mkdir()
            (self.folder / "theirs").write_text("kept")
            for name in written + [".log.frames.csv.part", ".log.frames.csv.journal"]:
                with self.subTest(app=app, name=name):
                    shutil.rmtree(self.folder / "out")
                    (self.folder / "out").mkdir()
                    (self.folder / "out" / name).symlink_to(self.folder / "theirs")
                    self.run_app(app, arguments)
                    self.assertEqual((self.folder / "theirs").read_text(), "kept")

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

    def files_written(self):
        out = self.folder / "out"
        return {path.name: path.read_text() for path in [out, *sorted(out.rglob("*"))]
                if path.is_file()}

    @unittest.skipUnless(BOUNDED, "sanitizers want to be loaded first")
    @unittest.skipUnless(shutil.which("localedef"), "no localedef")
    def test_the_locale_has_no_say(self):
        """Not even in a program that has taken on one with decimal commas."""
        german = self.folder / "locales/de_DE.UTF-8"
        german.parent.mkdir()
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", german],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if made.returncode != 0:
            self.skipTest(made.stdout.decode())
        library = self.folder / "user_locale.so"  # LD_PRELOAD knows no spaces
        shutil.copy(USER_LOCALE, library)
        environment = {**os.environ, "LC_ALL": german.name, "LOCPATH": str(german.parent),
                       "LD_PRELOAD": str(library)}
        comma = re.compile(rb"\d,\d")
        for app in APPS:
            with self.subTest(app=app):
                plain = self.run_app(app, self.put(app))
                files = self.files_written()
                self.assertTrue(files)
                # Five frames do not determine all of a finger.
                self.assertEqual(plain.returncode, 4 if app == "calibrate" else 0)
                outcome = self.run_app(app, self.put(app), env=environment)
                self.assertEqual(outcome.returncode, plain.returncode)
                self.assertEqual(self.files_written(), files)
        # That it has a say in what is printed shows that the test does test it.
        self.assertRegex(outcome.stdout, comma)
        self.assertNotRegex(plain.stdout, comma)

    def test_outputs_that_cannot_be_written(self):
        for app, (_, arguments) in APPS.items():
            flag = "--out" if app == "simulate" else "--out_dir"
            arguments = arguments.replace(f"{flag} out", f"{flag} taken/out")
            with self.subTest(app=app):
                self.put(app)
                (self.folder / "taken").write_text("a file")
                self.expect_refused(app, arguments, "taken/out")
                self.assertEqual((self.folder / "taken").read_text(), "a file")

    def on_small_disk(self, size, commands):
        """Shell commands where `out` is a disk of that size."""
        shell = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
        mount = f"mkdir -p out && mount -t tmpfs -o size={size} tmpfs out"
        run = functools.partial(subprocess.run, cwd=self.folder, timeout=SECONDS, check=False,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if not shutil.which("unshare") or run([*shell, mount]).returncode != 0:
            self.skipTest("no mounting here")
        return run([*shell, f"{mount}\n{commands}"])

    def test_a_full_device(self):
        arguments = self.put("simulate").replace("--out out", "--out /dev/full")
        line = self.expect_refused("simulate", arguments, "/dev/full")
        self.assertIn("No space left", line)

    def test_a_full_disk(self):
        for app in ("simulate", "calibrate", "control"):
            with self.subTest(app=app):
                arguments = self.put(app).replace("--out out", "--out out/result.csv")
                (self.folder / "in.csv").write_bytes(LOADS + b"60.5,1\n" * 2000)
                program = shlex.quote(str(BINARIES / f"finray_{app}"))
                outcome = self.on_small_disk("8k", f"{program} {arguments}; code=$?\n"
                                                   "ls -A out; exit $code")
                self.assertRegex(outcome.stderr.decode(),
                                 rf"\Afinray_{app}: out/.*: No space left on device\n\Z")
                self.assertEqual((outcome.returncode, outcome.stdout), (2, b""))

    def test_goes_on_when_a_full_disk_has_room_again(self):
        arguments = self.put("estimate")
        (self.folder / "scene.yaml").write_bytes(b"contacts: 0\n")
        header, *rows = LOG.splitlines(keepends=True)
        (self.folder / "log.csv").write_bytes(header + b"".join(rows) * 30000)
        program = shlex.quote(str(BINARIES / "finray_estimate"))
        outcome = self.on_small_disk("64m", f"""
            head -c 44M /dev/zero > out/other
            {program} {arguments} && exit 70
            test -e out/log.frames.csv && exit 71
            rm out/other
            {program} {arguments} --resume || exit 72
            cp out/log.frames.csv resumed.csv""")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertRegex(outcome.stderr, rb"\Afinray_estimate: out/log.frames.csv: .*"
                                         rb"No space left on device\n")
        self.assertRegex(outcome.stdout, rb"[1-9]\d* kept")
        self.run_app("estimate", arguments)
        self.assertEqual((self.folder / "resumed.csv").read_bytes(),
                         (self.folder / "out/log.frames.csv").read_bytes())

    def test_a_folder_that_may_not_be_written(self):
        if os.geteuid() == 0:
            self.skipTest("root writes everywhere")
        arguments = self.put("estimate")
        (self.folder / "kept").mkdir(mode=0o500)
        self.expect_refused("estimate", arguments.replace("_dir out", "_dir kept/out"),
                            "kept/out")

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

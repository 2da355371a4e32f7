#!/usr/bin/python3
"""Outputs that nobody takes, full disks, odd names and a foreign locale: files are whole or absent, and the exit code says so."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest
import urllib.parse

import yaml

sys.dont_write_bytecode = True
from good_inputs import APPS, LOADS, LOG  # noqa: E402
from hostile import BINARIES, BOUNDED, HostileCase, SECONDS  # noqa: E402

USER_LOCALE = BINARIES / "tests/libuser_locale.so"


class HostileOutputTest(HostileCase):
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

    def test_outputs_that_cannot_be_written(self):
        for app, (_, arguments) in APPS.items():
            flag = "--out" if app == "simulate" else "--out_dir"
            arguments = arguments.replace(f"{flag} out", f"{flag} taken/out")
            with self.subTest(app=app):
                self.put(app)
                (self.folder / "taken").write_text("a file")
                self.expect_refused(app, arguments, "taken/out")
                self.assertEqual((self.folder / "taken").read_text(), "a file")

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


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""Tools in Python end in one line and an exit code, and their plots do not depend on where they run."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMON = ROOT / "scripts/common"
sys.path.append(str(COMMON))

import figure_file  # noqa: E402

SCRIPT = """
import sys
sys.path.append({common!r})
import guard
guard.protect("tool", __name__)
from errors import BadInput, NoSolution, UsageError
print("begun")
{body}
"""
PLOT = """
import sys
sys.path.append({folder!r})
import {module} as style
figure, axes = style.plt.subplots(figsize=(2, 2))
axes.plot([0, 1], [1, 0])
{end}
"""


def python(text, **how):
    return subprocess.run(["/usr/bin/python3", "-B", "-c", text], capture_output=True, text=True, **how)


class GuardTest(unittest.TestCase):
    def test_what_a_script_raises_is_one_line_and_its_code(self):
        for body, code, line in (
                ("raise UsageError('--a is no flag')", 1, "tool: --a is no flag; see --help"),
                ("raise BadInput('a.csv:3: no number')", 2, "tool: a.csv:3: no number"),
                ("raise NoSolution('nothing')", 3, "tool: nothing"),
                ("raise KeyboardInterrupt", 130, "tool: interrupted"),
                ("raise MemoryError", 2, "tool: out of memory"),
                ("open('/none/a.csv')", 2, "tool: /none/a.csv: No such file or directory"),
                ("open(b'/none/\\xff\\n')", 2, "tool: /none/??: No such file or directory"),
                ("with open('/dev/full', 'w') as file: file.write('a')", 2, "tool: No space left on device (<string>:8)"),
                ("raise BadInput('a\\nb\\x1b[31m.csv: odd')", 2, "tool: a?b?[31m.csv: odd"),
                ("guard.words('Doc', 1, 2)", 1, "tool: expected 1 to 2 arguments, found 0; see --help"),
                ("sys.argv.append('--nope'); guard.words('Doc', 0)", 1, "tool: --nope is not a flag; see --help"),
                ("sys.argv.append('--help'); guard.words('Doc', 1)", 0, ""),
                ("guard.Parser().parse_args(['--nope'])", 1, "tool: unrecognized arguments: --nope; see --help"),
                ("import a_package_that_is_not", 2, "tool: needs a package that is not installed (No module named "
                 "'a_package_that_is_not'); see scripts/install_dependencies"),
                ("{}['a']", 2, "tool: cannot work on this input: KeyError: 'a' (<string>:8)"),
                ("import warnings; warnings.warn('odd')", 0, "")):
            with self.subTest(body):
                done = python(SCRIPT.format(common=str(COMMON), body=body))
                printed = "begun\n" + "Doc\n" * ("--help'" in body)
                self.assertEqual((done.returncode, done.stdout, done.stderr), (code, printed, line and line + "\n"))

    def test_a_full_disk_behind_stdout_is_exit_2(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run(["/usr/bin/python3", "-c", SCRIPT.format(common=str(COMMON), body="")], stdout=full,
                                  stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (2, "tool: stdout: No space left on device\n"))

    def test_users_scripts_have_the_guard(self):
        scripts = [path for folder in ("apps", "calib", "scripts") for path in sorted((ROOT / folder).rglob("*"))
                   if path.is_file() and re.match(rb"#!.*python", path.read_bytes()[:30])]
        self.assertGreater(len(scripts), 40)
        for path in scripts:
            with self.subTest(path.relative_to(ROOT)):
                self.assertIn("guard.protect(", path.read_text("utf-8"))

    def test_scripts_called_without_arguments_have_no_traceback(self):
        for name in ("check_names /none", "package/layout.py", "package/make_pages.py", "site/format_tables.py /none",
                     "model_errors/run /none", "reality/outcome.py", "studies/compare_frames.py /none /none",
                     "paper/structural_plant.py"):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                script, *arguments = name.split()
                done = subprocess.run(["/usr/bin/python3", ROOT / "scripts" / script, *arguments], cwd=folder,
                                      capture_output=True, text=True)
                self.assertNotIn("Traceback", done.stdout + done.stderr)
                self.assertIn(done.returncode, (0, 1, 2))

    def test_wrong_usage_is_exit_1_and_writes_nothing(self):
        """Of every script: a flag that none of them has is no name of a file."""
        scripts = [path for path in sorted((ROOT / "scripts").rglob("*")) if path.is_file() and path.name != "paper_experiments"
                   and re.match(rb"#!.*python", path.read_bytes()[:30])]
        for path in scripts:
            with self.subTest(path.relative_to(ROOT)), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run(["/usr/bin/python3", path, "--nope"], cwd=folder, capture_output=True, text=True)
                self.assertEqual(os.listdir(folder), [])
                if "needs a package that is not installed" in done.stderr:
                    continue
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (1, "", 1), done.stderr)
        for path, words in (("make_wandering_log.py", ["X"]), ("reality/outcome.py", ["a.csv"]), ("paper/simulate.py", [])):
            done = subprocess.run(["/usr/bin/python3", ROOT / "scripts" / path, *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)

    def test_a_folder_that_is_not_of_finray_control_is_bad_input(self):
        with tempfile.TemporaryDirectory() as folder:
            for text in (None, "[a", "experiments\n"):
                if text:
                    (pathlib.Path(folder) / "summary.yaml").write_text(text)
                done = subprocess.run(["/usr/bin/python3", ROOT / "scripts/control/plot.py", folder], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
                self.assertIn("summary.yaml is not that of finray_control", done.stderr)

    def test_docs_site_without_doxygen_says_what_is_missing(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["/usr/bin/python3", ROOT / "scripts/docs_site", pathlib.Path(folder) / "out"],
                                  capture_output=True, text=True, env={**os.environ, "PATH": folder})
        self.assertEqual((done.returncode, done.stderr),
                         (2, "docs_site: needs doxygen: scripts/install_dependencies site\n"))


class WholeFileTest(unittest.TestCase):
    def test_a_pipe_stays_a_pipe(self):
        with tempfile.TemporaryDirectory() as where:
            path = pathlib.Path(where, "pipe")
            os.mkfifo(path)
            reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
            try:
                figure_file.whole_file.write(path, "all of it")
                self.assertEqual(os.read(reader, 100), b"all of it")
            finally:
                os.close(reader)
            self.assertTrue(path.is_fifo())


class FigureFileTest(unittest.TestCase):
    def test_a_plot_that_finds_no_room_leaves_no_file(self):
        """In every look; no script draws into a file by another way."""
        limit = "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);" \
            "resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))\n"
        for folder, module, path in (("scripts/studies", "plot_style", "a.png"), ("scripts/perception", "perception_style", "a"),
                                     ("scripts/real", "pictures", "a.png")):
            with self.subTest(module), tempfile.TemporaryDirectory() as where:
                end = f"{limit}style.save(figure, {path!r})"
                done = python(PLOT.format(folder=str(ROOT / folder), module=module, end=end), cwd=where)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn("File too large", done.stderr)
                self.assertEqual(os.listdir(where), [])
        for folder in ("scripts", "calib/report", "python"):
            for path in (ROOT / folder).rglob("*.py"):
                if path.name not in ("figure_file.py", "theme.py"):
                    self.assertNotIn("savefig(", path.read_text("utf-8"), path)


class PlainMatplotlibTest(unittest.TestCase):
    def plot(self, folder, module, end, where, **more):
        done = python(PLOT.format(folder=str(ROOT / folder), module=module, end=end), cwd=where,
                      env={**os.environ, **more})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_matplotlibrc_changes_no_plot(self):
        svg = "import io\nout = io.StringIO()\nstyle.plt.rcParams['svg.hashsalt'] = 'a'\n" \
            "figure.savefig(out, format='svg', metadata={'Date': None})\nprint(out.getvalue())"
        styled, broken = b"lines.linewidth: 20\nfont.size: 40\nbackend: tkagg\n", b"\xff\xfe\x00 no text"
        with tempfile.TemporaryDirectory() as clean, tempfile.TemporaryDirectory() as odd:
            rc = pathlib.Path(odd) / "matplotlibrc"
            for folder, module, texts in (("calib/report", "theme", (styled, broken)),
                                          ("scripts/perception", "perception_style", (styled,)),
                                          ("scripts/studies", "plot_style", (broken,))):
                expected = self.plot(folder, module, svg, clean)
                self.assertIn("</svg>", expected)
                for text in texts:
                    with self.subTest(f"{module}, {text}"):
                        rc.write_bytes(text)
                        self.assertEqual(self.plot(folder, module, svg, odd, MATPLOTLIBRC=str(rc)), expected)


if __name__ == "__main__":
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        sys.exit(77)
    unittest.main()

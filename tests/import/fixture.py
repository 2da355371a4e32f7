"""What the tests of finray_import share: the tool in this process, and a folder of its own."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/import"), str(ROOT / "scripts/common")]

import import_log  # noqa: E402


class Result:
    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err


class ImportCase(unittest.TestCase):
    """self.folder: a fresh folder; self.run_import("--logs", ...): a Result."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def run_import(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = import_log.main([str(a) for a in arguments])
        return Result(code, out.getvalue(), err.getvalue())

    def log_of(self, *arguments):
        """The log as {column: [text of cells]}; the run is good."""
        log = self.folder / "log.csv"
        result = self.run_import(*arguments, "--out", log)
        self.assertEqual(result.code, 0, result.err)
        self.result = result
        rows = [line.split(",") for line in log.read_text().splitlines()]
        return dict(zip(rows[0], (list(column) for column in zip(*rows[1:]))))

    def refused(self, *arguments, code=2):
        """The one line of a run that ends early and writes nothing."""
        log, mapping = self.folder / "refused.csv", self.folder / "refused.mapping.yaml"
        log.unlink(missing_ok=True)
        mapping.unlink(missing_ok=True)
        result = self.run_import(*arguments, "--out", log)
        self.assertEqual(result.code, code, result.out + result.err)
        self.assertEqual(result.err.count("\n"), 1, result.err)
        self.assertFalse(log.exists())
        self.assertFalse(mapping.exists())
        return result.err

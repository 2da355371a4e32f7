#!/usr/bin/env python3
"""finray_convert: files of before and of today, and files that it cannot know."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/convert"), str(ROOT / "scripts/import"), str(ROOT / "scripts/common")]
from kinds import TODAY, kind_of, step  # noqa: E402

OLD = {  # name: text of a file without a version, text that it becomes, kind
    "commented": ("# my scene\n\n# contacts\ncontacts: 1  # one\n",
                  "# my scene\n\n# contacts\nschema_version: 1\ncontacts: 1  # one\n", "scene"),
    "flow": ("{contacts: 1}\n", "{schema_version: 1, contacts: 1}\n", "scene"),
    "document": ("%YAML 1.1\n---\nfriction_coefficient: 0.3\n",
                 "%YAML 1.1\n---\nschema_version: 1\nfriction_coefficient: 0.3\n", "scene"),
    "tagged": ("--- !!map\n# one\ncontacts: 1\n", "--- !!map\n# one\nschema_version: 1\ncontacts: 1\n", "scene"),
    "anchored": ("--- &top !!map  # all\n  contacts: 1\n", "--- &top !!map  # all\n  schema_version: 1\n  contacts: 1\n", "scene"),
    "tagged_flow": ("--- !!map {contacts: 1}\n", "--- !!map {schema_version: 1, contacts: 1}\n", "scene"),
    "marked_key": ("? contacts\n: 1\n", "schema_version: 1\n? contacts\n: 1\n", "scene"),
    "windows": ("delimiter: ';'\r\ncolumns: {U1: gauge_1_V}\r\n",
                "schema_version: 1\ndelimiter: ';'\r\ncolumns: {U1: gauge_1_V}\r\n", "mapping"),
    "finger": ((ROOT / "configs/fingers/paper_140mm.yaml").read_text().replace("schema_version: 1\n", "", 1), None, "finger"),
}


class ConvertTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def convert(self, *arguments):
        ended = subprocess.run([ROOT / "apps/finray_convert", *map(str, arguments)], capture_output=True, text=True,
                               cwd=self.folder)
        return ended.returncode, ended.stdout, ended.stderr

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text.encode())
        return path

    def test_every_version_has_a_step_to_the_next(self):
        for kind, today in TODAY.items():
            for version in range(today):
                self.assertTrue(callable(step(kind, version)), (kind, version))

    def test_files_without_a_version(self):
        for name, (text, expected, kind) in OLD.items():
            with self.subTest(name):
                path = self.write(f"{name}.yaml", text)
                self.assertEqual(self.convert("--files", path),
                                 (4, f"{path}: {kind}, without schema_version: needs version 1\n", ""))
                code, out, error = self.convert("--files", path, "--out_dir", "new")
                self.assertEqual((code, out, error), (0, f"{path}: {kind}, without schema_version: now version 1 -> "
                                                         f"new/{name}.yaml\n", ""))
                found = (self.folder / f"new/{name}.yaml").read_bytes().decode()
                if expected:
                    self.assertEqual(found, expected)
                self.assertEqual(yaml.safe_load(found), {"schema_version": 1, **yaml.safe_load(text)})
                self.assertEqual(path.read_bytes().decode(), text)  # inputs stay

    def test_files_of_today_are_copied(self):
        paths = sorted(p for folder in ("configs", "datasets") for p in (ROOT / folder).rglob("*.yaml")
                       if "schema_version: 1" in p.read_text())
        self.assertGreater(len(paths), 20)
        for path in paths:
            code, out, error = self.convert(f"--files={path}", "--out_dir", self.folder / "same")
            self.assertEqual((code, error), (0, ""), path)
            self.assertIn("version 1: is today's", out)
            self.assertEqual((self.folder / "same" / path.name).read_bytes(), path.read_bytes())

    def test_results_are_called_what_they_are_and_stay(self):
        frozen = ROOT / "tests/data/formats/1.0"
        inputs = {"sha256": "0"}
        for kind, text in (
                ("calibration", (frozen / "calibration/calibration.yaml").read_text()),
                ("summary", (frozen / "estimated/summary.yaml").read_text()),
                ("summary", (frozen / "estimated/log.summary.yaml").read_text()),
                ("validation", yaml.safe_dump({"schema_version": 1, "verdict": "no_gates", "gates": [], "errors": {}, "inputs": inputs})),
                ("comparison", yaml.safe_dump({"schema_version": 1, "verdict": "passed", "shared_logs": 0, "parameters": [], "gates": []})),
                ("control summary", yaml.safe_dump({"finger": "f", "inputs": inputs, "experiments": []})),
                ("reconstruction", yaml.safe_dump({"touches": {}, "descriptors": [], "inputs": [inputs]})),
                ("compliance", yaml.safe_dump({"order_confidence": 1, "objects": [], "inputs": [inputs]}))):
            path = self.write("result.yaml", text)
            code, out, error = self.convert("--files", path, "--out_dir", "new")
            version = "version 1" if "schema_version" in text else "without schema_version"
            self.assertEqual((code, out, error), (0, f"{path}: {kind}, {version}: is today's -> new/result.yaml\n", ""))
            self.assertEqual((self.folder / "new/result.yaml").read_bytes(), path.read_bytes())

    def test_kinds(self):
        for folder, kind in (("fingers", "finger"), ("scenes", "scene"), ("plans", "plan"), ("control", "experiment")):
            for path in (ROOT / "configs" / folder).glob("*.yaml"):
                self.assertEqual(kind_of(yaml.safe_load(path.read_text())), kind, path)

    def test_what_it_cannot_know_is_refused(self):
        good = self.write("good.yaml", "contacts: 1\n")
        for name, text, message in [
                ("later", "contacts: 1\nschema_version: 2\n", "later.yaml:2: schema_version: a later finray has written this "
                                                              "scene; this one knows versions to 1"),
                ("word", "schema_version: one\ncontacts: 1\n", "word.yaml:1: schema_version: expected 1 to 1"),
                ("other", "apples: 3\n", "other.yaml: is none of finray's files"),
                ("list", "- 1\n", "list.yaml:1: expected a mapping"), ("empty", "", "empty.yaml: is empty"),
                ("broken", "contacts: [1\n", "broken.yaml:2:")]:
            path = self.write(f"{name}.yaml", text)
            code, out, error = self.convert("--files", f"{good},{path}", "--out_dir", "new")
            self.assertEqual((code, out, error.count("\n")), (2, "", 1), error)
            self.assertIn(message, error)
            self.assertFalse((self.folder / "new").exists())
        self.assertEqual(self.convert("--files", "none.yaml")[0], 2)
        code, _, error = self.convert("--files", good, "--out_dir", ".")
        self.assertEqual((code, "would be written over" in error), (2, True))
        self.assertEqual(good.read_text(), "contacts: 1\n")

    def test_wrong_use(self):
        for arguments in ((), ("--file", "a"), ("a.yaml",), ("--files",)):
            self.assertEqual(self.convert(*arguments)[0], 1, arguments)
        self.assertEqual(self.convert("--files", "a/x.yaml,b/x.yaml", "--out_dir", "new")[0], 1)
        self.assertEqual(self.convert("--help")[0], 0)
        self.assertRegex(self.convert("--version")[1], r"^finray_convert version \d")


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""The tables of docs/reference/formats.md are those of the code, the page explains every key that users write and every column of a log, and
it shows no key that no reader knows."""
import os
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
PAGE = (ROOT / "docs/reference/formats.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"<!-- (\w+): from the code -->\n([\s\S]*?)<!-- end -->\n")
KEY = r"[a-z][a-zA-Z0-9_]*"


def names_of(block):
    """The keys and columns of a table, without the mappings or units that they stand in."""
    cells = re.sub(r"^\| [^|]* \|", "", block, flags=re.M)
    return set(re.findall(rf"`({KEY}(?:<\w>_?{KEY})?|{KEY}_<\w>\w*)`", cells))


def spans(text):
    """Everything that stands in a code span or a block of YAML."""
    blocks = re.findall(r"^```yaml\n([\s\S]*?)^```", text, re.M)
    inline = re.findall(r"`([^`\n]+)`", re.sub(r"^```[\s\S]*?^```", "", text, flags=re.M))
    return "\n".join(blocks + inline)


def keys_shown(text):
    """Keys of the blocks of YAML: a word before a colon, outside comments."""
    blocks = "\n".join(re.findall(r"^```yaml\n([\s\S]*?)^```", text, re.M))
    return set(re.findall(rf"(?:^|[{{,\s-])({KEY}):(?=\s|$)", re.sub(r"#.*", "", blocks), re.M))


class FormatsTest(unittest.TestCase):
    def test_tables_are_those_of_the_code(self):
        if not (BINARIES / "tests/format_reader").exists():
            self.skipTest("format_reader is not built")
        ended = subprocess.run(["/usr/bin/python3", ROOT / "scripts/site/format_tables.py", BINARIES, "--check"], capture_output=True,
                               text=True)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertRegex(ended.stdout, r"^21 blocks, 1\d\d\d names\n")

    def test_every_key_and_column_is_explained(self):
        prose = BLOCK.sub("", PAGE)
        words = set(re.findall(rf"{KEY}(?:<\w>\w*)?", spans(prose)))
        # finray_import's own page and guide explain its mapping.
        more = "".join((ROOT / "docs" / page).read_text(encoding="utf-8") for page in ("reference/import.md", "guides/import_a_labs_files.md"))
        for name, block in BLOCK.findall(PAGE):
            if name not in ("finger", "scene", "plan", "experiment", "mapping", "columns", "estimate"):
                continue
            names = names_of(block)
            self.assertGreater(len(names), 20, name)
            explained = words | set(re.findall(KEY, more)) if name == "mapping" else words
            unit = {key for key in names if any(f"{key.removesuffix(end)}_" in explained for end in ("_N", "_mm", "_mm_s", "_deg_s"))}
            self.assertEqual(sorted(names - explained - unit), [], f"{name}: not explained")

    def test_no_key_is_shown_that_no_reader_knows(self):
        known = {key for _, block in BLOCK.findall(PAGE) for key in names_of(block)}
        headers = {"U1", "U2", "ch0", "ch1", "Fz", "stage_x", "t"}
        self.assertEqual(sorted(keys_shown(BLOCK.sub("", PAGE)) - known - headers), [])


if __name__ == "__main__":
    sys.exit(unittest.main())

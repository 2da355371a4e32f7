#!/usr/bin/python3
"""scripts/package/make_pages.py: each tool has a man page and a completion, with every flag of its source."""
import gzip
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
EXECUTABLES = sorted(source.stem for source in (ROOT / "apps").glob("finray_*.cc"))


def flags_of(name):
    if name == "finray_import":
        return re.findall(r'Flag\("(\w+)",', (ROOT / "scripts/import/flags.py").read_text())
    return re.findall(r"^DEFINE_\w+\(\s*(\w+),", (ROOT / f"apps/{name}.cc").read_text(), re.M)


class PagesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tools = [name for name in [*EXECUTABLES, "finray_import"] if (BUILD / name).exists()]
        if not cls.tools:
            print("skipped: no executable is built")
            sys.exit(77)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.pages = pathlib.Path(folder.name)
        subprocess.run([sys.executable, ROOT / "scripts/package/make_pages.py", "1.2.3", cls.pages,
                        *(BUILD / name for name in cls.tools)], check=True)

    def page(self, name):
        return gzip.decompress((self.pages / f"man1/{name}.1.gz").read_bytes()).decode()

    def test_every_flag_is_in_the_man_page_with_words(self):
        for name in self.tools:
            page = self.page(name)
            self.assertIn(f'.TH {name.upper()} 1 "" "finray 1.2.3" "finray"\n.SH NAME\n{name} \\- ', page)
            for flag in [*flags_of(name), "version"]:
                self.assertRegex(page, rf"\n\.TP\n\\fB\\-\\-{flag}\\fR\n\S", (name, flag))
            for word in (".SH SYNOPSIS\n", ".SH EXIT STATUS\n", ".SH SEE ALSO\n"):
                self.assertEqual(page.count(word), 1, (name, word))

    def test_every_flag_is_completed_by_bash(self):
        for name in self.tools:
            done = subprocess.run(
                ["bash", "-c", f". {self.pages}/completions/{name}; COMP_WORDS=({name} --) COMP_CWORD=1; _{name}; "
                 f"printf '%s\\n' \"${{COMPREPLY[@]}}\"; complete -p {name}"], capture_output=True, text=True, check=True)
            *words, declared = done.stdout.splitlines()
            self.assertEqual(declared, f"complete -o default -F _{name} {name}")
            self.assertLessEqual({f"--{flag}" for flag in [*flags_of(name), "help", "version"]}, set(words))

    def test_a_prefix_leaves_its_flags(self):
        name = self.tools[0]
        flag = flags_of(name)[0]
        done = subprocess.run(["bash", "-c", f". {self.pages}/completions/{name}; COMP_WORDS=({name} --{flag}) "
                               f"COMP_CWORD=1; _{name}; echo ${{COMPREPLY[@]}}"], capture_output=True, text=True, check=True)
        self.assertIn(f"--{flag}", done.stdout.split())
        self.assertTrue(all(word.startswith(f"--{flag}") for word in done.stdout.split()))


if __name__ == "__main__":
    unittest.main()

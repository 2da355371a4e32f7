#!/usr/bin/env python3
"""docs/guides/add_a_residual.md: its quotations are those of the sources, and its
commands do what it says. The executables are in FINRAY_BINARY_DIR."""
import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/guides/add_a_residual.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
PATH = re.compile(r"`((?:libfinray|calib)/[\w/.]+)`")
TABLE = re.compile(r"^\| \d+ mm, \d N \| (.*?) \| (.*?) \|$", re.M)
FILE = re.compile(r"`(\w+\.(?:csv|yaml))`:?\s*$")


def words(text):
    return " ".join(text.split())


def run(blocks, folder):
    """Writes the files of the page into the folder and runs its commands there."""
    (folder / "configs").symlink_to(ROOT / "configs")
    environment = dict(os.environ)
    environment["PATH"] = os.environ["FINRAY_BINARY_DIR"] + ":" + environment["PATH"]
    for language, before, text in blocks:
        if language in ("csv", "yaml"):
            (folder / FILE.search(before)[1]).write_text(text)
        elif language == "sh":
            subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment,
                           check=True, stdout=subprocess.DEVNULL)


def rows(path):
    with open(path, newline="") as table:
        return list(csv.DictReader(table))


def main():
    page = PAGE.read_text(encoding="utf-8")
    blocks = [(m[1], page[:m.start()].rstrip(), m[2]) for m in BLOCK.finditer(page)]
    for language, before, text in blocks:
        if language != "cpp":
            continue
        path = PATH.findall(before)[-1]
        if words(text) not in words((ROOT / path).read_text(encoding="utf-8")):
            sys.exit(f"{path} does not hold:\n{text}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(blocks, folder)
        found = list(zip(*(rows(folder / case / "log.frames.csv") for case in ("gauges", "camera"))))
    for line, cases in zip(TABLE.findall(page), found):
        for cell, row in zip(line, cases):
            status, *stds = cell.split(", ")
            assert row["status"] == status, (line, row)
            for column, std in zip(("contact_1_std_mm", "normal_1_std_N"), stds):
                assert abs(float(row[column]) - float(std)) < 0.03 * float(std) + 0.0005, (line, row)
    assert len(TABLE.findall(page)) == 5


if __name__ == "__main__":
    main()

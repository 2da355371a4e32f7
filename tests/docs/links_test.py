#!/usr/bin/env python3
"""Every page, picture and heading that a document links exists. So does every path
below docs/ that a source or a document names, and every test program, test and
source file that a document names."""
import fnmatch
import pathlib
import re
import sys
import unicodedata

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = {".h", ".cc", ".in", ".py", ".m", ".txt", ".yaml", ".cmake", ".md", ".jinja", ""}
LINK = re.compile(r"\]\(([^)\s]+)\)")
DOCS_PATH = re.compile(r"(?<![\w./-])docs/[\w./-]*\w")
PROGRAM = re.compile(r"`(?:[^`\n]*[\s/])?(\w+_(?:test|study|benchmark))(?:[\s][^`\n]*)?`")
HEADING = re.compile(r"^#+ +(.*)$")
TEST = re.compile(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)")
FILTER = re.compile(r"--gtest_filter='?([^\s'`|]+)|`(\w+Test\.\w*\*?)`")
SOURCE = re.compile(r"`(?:[\w/]+/)?(\w+\.(?:h|cc|py))`")
ANY_TEST = "x_test.cc"  # stands for the test of x.h


def files():
    """All text files of the tree, without builds, results and hidden folders."""
    for path in sorted(ROOT.rglob("*")):
        parts = path.relative_to(ROOT).parts
        if parts[0] in ("build", "out") or any(p.startswith(".") and p != ".ci" for p in parts):
            continue
        if "corpus" in parts or "__pycache__" in parts:
            continue
        if path.is_file() and path.suffix in SOURCES:
            yield path


def without_code(text):
    """The text with its fenced blocks emptied; the numbers of lines stay."""
    lines, fenced = [], False
    for line in text.split("\n"):
        fence = line.lstrip().startswith("```")
        lines.append("" if fenced or fence else line)
        fenced ^= fence
    return lines


def anchors(page):
    """The names by which a Markdown viewer knows the headings of a page."""
    names = set()
    for line in without_code(page.read_text(encoding="utf-8")):
        heading = HEADING.match(line)
        if not heading:
            continue
        title = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
        name = "".join("-" if c == " " else c for c in title
                       if c in " -_" or unicodedata.category(c)[0] in "LN")
        names.add(name)
    return names


def programs():
    """The names of all executables of tests/."""
    names = set(re.findall(r"\b\w+_test\b", (ROOT / "tests/CMakeLists.txt").read_text()))
    for pattern in ("*_study.cc", "*_benchmark.cc", "*_test.py"):
        names.update(path.stem for path in (ROOT / "tests").rglob(pattern))
    names.update(path.stem for path in (ROOT / "apps").glob("finray_*.cc"))
    return names


def tests():
    """The full names of all tests, with the prefix of parameterised ones left out."""
    return {".".join(names) for path in (ROOT / "tests").rglob("*.cc")
            for names in TEST.findall(path.read_text(encoding="utf-8"))}


def sources():
    return {path.name for folder in ("libfinray", "calib", "apps", "api", "python", "examples", "scripts", "tests")
            for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cc", ".py")}


def name_faults(line, known):
    """What a line of a page names and the tree does not have."""
    for name in PROGRAM.findall(line):
        if name not in known["programs"]:
            yield f"{name}: no such test program"
    for filters in FILTER.findall(line):
        for pattern in "".join(filters).split(":"):
            if not fnmatch.filter(known["tests"], pattern):
                yield f"{pattern}: no such test"
    for name in SOURCE.findall(line):
        if name not in known["sources"] | {ANY_TEST}:
            yield f"{name}: no such source"


def link_fault(page, target):
    """What is wrong with a link of a page, or None."""
    if re.match(r"[a-z]+:", target):
        return None
    path, _, anchor = target.partition("#")
    linked = page.parent / path if path else page
    if not linked.exists():
        return "no such file"
    if anchor and linked.suffix == ".md" and anchor not in anchors(linked):
        return "no such heading"
    return None


def faults():
    known = {"programs": programs(), "tests": tests(), "sources": sources()}
    for path in files():
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        where = path.relative_to(ROOT)
        for number, line in enumerate(text.split("\n"), 1):
            for name in DOCS_PATH.findall(line):
                if not (ROOT / name).exists():
                    yield f"{where}:{number}: {name}: no such file"
        if path.suffix != ".md":
            continue
        for number, line in enumerate(without_code(text), 1):
            for target in LINK.findall(line):
                fault = link_fault(path, target)
                if fault:
                    yield f"{where}:{number}: {target}: {fault}"
            for fault in name_faults(line, known):
                yield f"{where}:{number}: {fault}"


def main():
    found = list(faults())
    for fault in found:
        print(fault)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

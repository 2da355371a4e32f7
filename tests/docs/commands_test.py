#!/usr/bin/env python3
"""docs/reference/commands.md names every flag of every executable, and no other."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROW = re.compile(r"^\| (`--[^|]*) \|", re.M)


def flags_of_rows(section):
    return {flag for row in ROW.findall(section) for flag in re.findall(r"`--(\w+)`", row)}


def main():
    page = (ROOT / "docs/reference/commands.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## (.*)\n([\s\S]*?)(?=^## |\Z)", page, re.M))
    shared = flags_of_rows(sections["Flags that mean the same everywhere"])
    faults = []
    for source in sorted((ROOT / "apps").glob("finray_*.cc")):
        documented = flags_of_rows(sections.get(source.stem, ""))
        defined = set(re.findall(r"^DEFINE_\w+\(\s*(\w+),", source.read_text(), re.M))
        faults += [f"{source.stem}: --{flag} is missing in the page"
                   for flag in sorted(defined - shared - documented)]
        faults += [f"{source.stem}: there is no flag --{flag}"
                   for flag in sorted(documented - defined)]
    # Tools in Python have all their flags in their own sections.
    in_python = {"finray_import": re.findall(r'Flag\("(\w+)",', (ROOT / "scripts/import/flags.py").read_text()),
                 "finray_convert": re.findall(r"^  --(?!version)(\w+) ", (ROOT / "scripts/convert/convert.py").read_text(), re.M)}
    for tool, defined in in_python.items():
        documented = flags_of_rows(sections[tool])
        faults += [f"{tool}: --{flag} is missing in the page" if flag in defined else
                   f"{tool}: there is no flag --{flag}" for flag in sorted(set(defined) ^ documented)]
    print(*faults, sep="\n", end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

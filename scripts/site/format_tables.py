#!/usr/bin/python3
"""Writes the tables of docs/reference/formats.md that stand between `<!-- NAME: from the code -->` and `<!-- end -->`.

usage: scripts/site/format_tables.py BUILD [--check]      (BUILD/tests/format_reader and the executables are built)

--check writes nothing, prints what differs and ends with 1 if anything does.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/site"))

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("format_tables.py", __name__)

import format_keys  # noqa: E402
import format_results  # noqa: E402

PAGE = ROOT / "docs/reference/formats.md"
BLOCK = re.compile(r"(<!-- (\w+): from the code -->\n)([\s\S]*?)(<!-- end -->)")
# Formats that stand in another one, and are shown there.
ELSEWHERE = {"plan": ("scene", "columns"), "experiment": ("scene",)}


def keys_table(mappings):
    rows = ["| mapping | keys; required ones are bold, defaults in brackets |", "|---|---|"]
    for path, mapping in mappings.items():
        if mapping.free and not mapping.keys:
            continue
        cells = []
        for name, key in mapping.keys.items():
            # time_origin says what was used, and its reader passes over it.
            if not key.kinds and name != "time_origin":
                raise RuntimeError(f"no sample of tests/docs/samples has {path}.{name}")
            shown = "any name" if name == "*" else f"`{name}`"
            if mapping.is_needed(key) and not mapping.free:
                shown = f"**{shown}**"
            kinds = "" if key.kinds == ["mapping"] else ", or ".join(key.kinds)
            default = key.default()
            cells.append(f"{shown} {kinds}".strip() + (f" ({default})" if default else ""))
        shown = f"`{path.replace('*', '<name>')}`" if path else "the file"
        rows.append(f"| {shown} | {'; '.join(cells)} |".replace("`|`", "`\\|`"))
    return "\n".join(rows) + "\n"


def results_table(found, others):
    rows = ["| mapping | keys |", "|---|---|"]
    for path, keys in found.items():
        shown = path if path == format_results.ERROR_TABLE else f"`{path}`" if path else "the file"
        rows.append(f"| {shown} | {', '.join(f'`{key}`' for key in keys)} |")
    if others:
        rows.append(f"| in some results | {', '.join(f'`{key}`' for key in others)} |")
    return "\n".join(rows) + "\n"


def files_table(tables):
    rows = ["| file | columns |", "|---|---|"]
    rows += [f"| `{file}` | {', '.join(f'`{pattern}`' for pattern in patterns(names))} |" for file, names in tables]
    return "\n".join(rows) + "\n"


def patterns(names):
    """gauge_1_V, gauge_2_V: gauge_<j>_V."""
    letters = {"gauge": "j", "contact": "c", "normal": "c", "friction": "c", "rib": "i"}
    return list(dict.fromkeys(re.sub(r"(gauge|contact|normal|friction|rib)_(?:\d+|#)", lambda m: f"{m[1]}_<{letters[m[1]]}>", name)
                              for name in names))


def listed(build, what):
    return subprocess.run([build / "tests/format_reader", what], capture_output=True, text=True, cwd=ROOT, check=True).stdout.splitlines()


def tables(build, folder):
    """{name: text} of all blocks."""
    made = {}
    for kind in ("finger", "scene", "plan", "experiment", "mapping"):
        reader = format_keys.MappingReader(folder) if kind == "mapping" else format_keys.CompiledReader(build, kind, folder)
        made[kind] = keys_table(format_keys.keys_of(reader, format_keys.samples_of(kind), ELSEWHERE.get(kind, ())))
    units = dict(line.split("\t") for line in listed(build, "columns"))
    by_unit = {}
    for column, unit in units.items():
        by_unit.setdefault(unit or "none", []).extend(patterns([column]))
    made["columns"] = "\n".join(["| unit | columns |", "|---|---|"] + [
        f"| {unit} | {', '.join(f'`{column}`' for column in names)} |" for unit, names in by_unit.items()]) + "\n"
    made["estimate"] = ", ".join(f"`{name}`" for name in patterns(listed(build, "estimates"))) + "\n"
    format_results.run_all(build, pathlib.Path(folder))
    for name in format_results.WRITTEN:
        found, others = format_results.yaml_keys(name, pathlib.Path(folder))
        made[name] = results_table(found, others if name != "log_summary" else [])  # `summary` has those of both
    for name in format_results.TABLES:
        made[name] = files_table(format_results.columns(name, pathlib.Path(folder)))
    return made


def main():
    given = guard.words(__doc__, 1, 1, ["--check"])
    build, = [word for word in given if word != "--check"]
    with tempfile.TemporaryDirectory() as folder:
        made = tables(pathlib.Path(build).resolve(), folder)
    page = PAGE.read_text(encoding="utf-8")
    blocks = {name: text for _, name, text, _ in BLOCK.findall(page)}
    if blocks.keys() != made.keys():
        sys.exit(f"{PAGE.relative_to(ROOT)}: blocks only in the page or only in the code: {sorted(blocks.keys() ^ made.keys())}")
    stale = [name for name in made if made[name] != blocks[name]]
    print(f"{len(made)} blocks, {sum(text.count('`') // 2 for text in made.values())} names")
    if "--check" in given:
        for name in stale:
            for line in sorted(set(made[name].splitlines()) ^ set(blocks[name].splitlines())):
                print(f"{name}: {'page' if line in blocks[name] else 'code'}: {line}")
        if stale:
            print("run scripts/site/format_tables.py BUILD")
        return 1 if stale else 0
    PAGE.write_text(BLOCK.sub(lambda m: m[1] + made[m[2]] + m[4], page), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())

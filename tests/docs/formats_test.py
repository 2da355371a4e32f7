#!/usr/bin/python3
"""docs/reference/formats.md has every key that the readers of YAML take, and no key that none of them takes."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIBFINRAY, CALIB = ROOT / "libfinray/finray", ROOT / "calib/finray/calib"
# The readers of the files that users write, by the sections that describe them.
READERS = {
    ("Finger",): [LIBFINRAY / "finger/finger_yaml.cc", LIBFINRAY / "finger/parameter_covariance_yaml.cc"],
    ("Scene", "Frame table"): [LIBFINRAY / "scene/scene.cc", LIBFINRAY / "io/column_mapping.cc"],
    ("Plan",): [CALIB / "problem/plan.cc"],
    ("Force-control experiment",): [LIBFINRAY / "control/experiment.cc"],
}
KEY = r"[a-z][a-zA-Z0-9_]*"
# What asks a YamlMap for a key: yaml.Number("key"), AllowOnly({"a", "b"}), keys = {"a", "b"}.
ASKED = re.compile(rf'\b(?:\w*[Yy]aml|map|entry|object|geometry|shared|flat|creep|top|place|rib|gauge)(?:\.|->)(?!Fail)[A-Z]\w*\(\s*"({KEY})"')
LISTS = re.compile(r'(?:AllowOnly\(\s*\{|\bkeys(?:\s*=\s*|)\{|push_back\()([^;]*?)(?:\}|\))')
ROWS = re.compile(rf'\{{("{KEY}"(?:,\s*"{KEY}")+)')  # {"front_stiffness", "prior_std_percent"}
LITERAL = re.compile(rf'"({KEY})"')


def section(page, title):
    found = re.search(rf"^## {re.escape(title)}\n([\s\S]*?)(?=^## |\Z)", page, re.M)
    return found[1] if found else ""


def keys_read(text):
    keys = set(ASKED.findall(text))
    for inside in LISTS.findall(text) + ROWS.findall(text):
        keys |= set(LITERAL.findall(inside))
    return keys


def words(text):
    """Everything that stands in a code span or a block of YAML."""
    blocks = re.findall(r"^```yaml\n([\s\S]*?)^```", text, re.M)
    spans = re.findall(r"`([^`\n]+)`", re.sub(r"^```[\s\S]*?^```", "", text, flags=re.M))
    return set(re.findall(KEY, "\n".join(blocks + spans)))


def keys_shown(text):
    """Keys of the blocks of YAML: a word before a colon, outside comments."""
    blocks = "\n".join(re.findall(r"^```yaml\n([\s\S]*?)^```", text, re.M))
    return set(re.findall(rf"(?:^|[{{,\s-])({KEY}):(?=\s|$)", re.sub(r"#.*", "", blocks), re.M))


def main():
    page = (ROOT / "docs/reference/formats.md").read_text(encoding="utf-8")
    everywhere = set(re.findall(KEY, page[page.index("### Logs as labs write them"):page.index("### Lists of logs")]))
    library = set(LITERAL.findall("\n".join(path.read_text() for folder in (LIBFINRAY, CALIB) for path in folder.rglob("*.cc"))))
    everywhere |= words(section(page, "Versions of formats"))
    prefixes = tuple(re.findall(r'"([a-z]\w*)"\s*\+', "\n".join(path.read_text() for path in LIBFINRAY.rglob("*.cc"))))
    faults, count = [], 0
    for titles, sources in READERS.items():
        text = "".join(section(page, title) for title in titles)
        if not text:
            faults.append(f"there is no section {titles}")
        known = words(text) | everywhere
        for source in sources:
            keys = keys_read(source.read_text(encoding="utf-8"))
            count += len(keys)
            faults += [f"{source.relative_to(ROOT)} reads '{key}', which is missing under '{titles[0]}'" for key in sorted(keys - known)]
        if "Frame table" not in titles:  # its blocks have headers of a lab
            faults += [f"'{titles[0]}' shows '{key}', which no reader knows" for key in sorted(keys_shown(text) - library)
                       if not key.startswith(prefixes)]  # "value_" + unit
    if count < 100:
        faults.append(f"only {count} keys were found in the readers")
    print(f"{count} keys of {sum(map(len, READERS.values()))} readers")
    print(*faults, sep="\n", end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

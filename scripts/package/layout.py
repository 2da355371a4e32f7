#!/usr/bin/python3
"""Prints size, members and their offsets of every class of the public headers, and values of its enumerations.

layout.py INCLUDE_DIR

A line a class, "Contact 88: arc_mm 0, arc_std_mm 8, ...", from the debug information of a source that includes them.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("layout.py", __name__)

ENTRY = re.compile(r"^ <([0-9a-f]+)><[0-9a-f]+>: Abbrev Number: \d+ \(DW_TAG_(\w+)\)")
VALUE = re.compile(r"^ +<[0-9a-f]+> +DW_AT_(\w+) *: (?:\(indirect string, offset: 0x[0-9a-f]+\): )?(.*?)\s*$")
TYPES = ("class_type", "structure_type", "enumeration_type")


def entries(text):
    """(depth, tag, attributes) of each entry."""
    found = None
    for line in text.splitlines():
        if entry := ENTRY.match(line):
            if found:
                yield found
            found = int(entry[1], 16), entry[2], {}
        elif found and (value := VALUE.match(line)):
            found[2][value[1]] = value[2]
    yield found


def layouts(text):
    """"Class size" to "member offset" of all in namespace finray::v1; what has no size is defined elsewhere."""
    spaces, within, members, found = {}, None, None, {}
    for depth, tag, of in entries(text):
        if tag == "namespace":
            spaces[depth] = of.get("name")
            within = depth if (spaces.get(depth - 1), spaces[depth]) == ("finray", "v1") else None
        elif within is None or depth <= within:
            within = members = None
        elif depth == within + 1:
            known = tag in TYPES and "name" in of and "byte_size" in of
            members = found.setdefault(f"{of['name']} {of['byte_size']}", []) if known else None
        elif members is not None and depth == within + 2:
            place = of.get("data_member_location" if tag == "member" else "const_value")
            if tag in ("member", "enumerator") and place is not None and "external" not in of:
                members.append(f"{of.get('name', '')} {place}")
            elif tag == "inheritance":
                members.append(f"(base) {of.get('data_member_location', 0)}")
    return found


def main():
    include = pathlib.Path(*guard.words(__doc__, 1, 1))
    with tempfile.TemporaryDirectory() as folder:
        source, built = pathlib.Path(folder, "all.cc"), pathlib.Path(folder, "all.o")
        source.write_text("".join(f'#include "{path.relative_to(include)}"\n' for path in sorted(include.rglob("*.h"))))
        subprocess.run(["g++", "-std=c++17", "-g", "-gdwarf-5", "-fno-eliminate-unused-debug-types",
                        "-femit-class-debug-always", "-I", include, "-isystem", "/usr/include/eigen3", "-c", source,
                        "-o", built], check=True)
        text = subprocess.check_output(["objdump", "--dwarf=info", built], text=True)
    for name, members in sorted(layouts(text).items()):
        print(f"{name}: {', '.join(members)}")


if __name__ == "__main__":
    main()

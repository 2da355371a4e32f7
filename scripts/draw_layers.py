#!/usr/bin/python3
"""Draws docs/pictures/layers.svg: the rooms of the library and of the calibration.

draw_layers.py [OUT.svg]

Exit code 1 if a room includes one that is not below it, or is not drawn, or looks into ladder/ where
statics/equilibrium.h would do, or if a folder of the calibration includes one that comes later.
"""

import pathlib
import re
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "scripts/common"))
import guard  # noqa: E402

guard.protect("draw_layers.py", __name__)

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "calib/report"))
import whole_file  # noqa: E402

INCLUDE = re.compile(r'#include "finray/([^"\n]*)/[^/"\n]+"')

# From top to bottom; a room may include rooms of the rows below it only.
ROWS = [
    [("apps", "the executables: flags, files, exit codes"), ("api", "public headers, libfinray.so.1; python on top")],
    [("calib", "from plan and logs to a calibrated finger"),
     ("perception", "outlines, stiffness"), ("control", "force control"), ("benchmark", "speed, error")],
    [("view", "pages of results, the live page and its server")],
    [("batch", "many logs: jobs, streams, result rows, summaries")],
    [("estimation", "contacts from gauges: starts, competing minima, status; whole logs")],
    [("fit", "the contact of one frame fitted to its blocks, linearised by contact and parameters")],
    [("residuals", "the heart: a frame's measurements as Ceres blocks, for estimation and calib alike")],
    [("model", "a finger under load: outputs and derivatives, by statics or Chebyshev polynomials")],
    [("scene", "what an experiment contains; measurements of a row, their reader; simulation")],
    [("objects", "outlines, clearance, tangency, contact of an object")],
    [("statics", "the face of the physics: equilibrium, sensitivities, shape, load path")],
    [("ladder", "the fast kernel: marching, elements, lanes, mesh"), ("chain", "the paper's formulation as written")],
    [("finger", "description, geometry, gauges, covariance of a calibration")],
    [("io", "tables, YAML with places, files that survive")],
]
# The folders of the calibration; each may include itself and those before it.
STAGES = ["problem", "solve", "analysis", "design", "report"]

WIDTH, ROW, GAP, EDGE = 900, 46, 10, 16
INK, QUIET, PAPER = "#22272e", "#5b6572", "#ffffff"
BOX, HEART, CERES = "#eef2f6", "#fbe6d4", "#b3541e"


def includes():
    """For each room the rooms that it includes, and the rooms that include Ceres."""
    rooms, ceres = {}, set()
    for folder in ("libfinray/finray", "calib/finray"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".h", ".cc"):
                continue
            room = path.relative_to(ROOT / folder).parts[0]
            text = path.read_text(encoding="utf-8")
            used = {name.split("/")[0] for name in INCLUDE.findall(text)} - {room}
            rooms.setdefault(room, {}).update({name: path for name in used})
            if "#include <ceres/" in text:
                ceres.add(room)
    return rooms, ceres


def faults(rooms):
    level = {name: i for i, row in enumerate(ROWS) for name, _ in row}
    for room, used in rooms.items():
        if room not in level:
            yield f"{room}: not drawn"
            continue
        for name, path in used.items():
            if name not in level or level[name] <= level[room]:
                yield f"{path.relative_to(ROOT)}: {room} includes {name}, which is not below it"


def late_stages():
    """Files of the calibration that include a later folder of it."""
    for i, stage in enumerate(STAGES):
        later = re.compile(f'#include "finray/calib/({"|".join(STAGES[i + 1:]) or "$"})/')
        for path in sorted((ROOT / "calib/finray/calib" / stage).iterdir()):
            if found := later.search(path.read_text(encoding="utf-8")):
                yield f"{path.relative_to(ROOT)}: {stage} includes {found[1]}, which comes later"


def peeks():
    """Files that include the fast kernel and are neither part of it nor of the code written for its speed."""
    for folder in ("libfinray/finray", "calib/finray", "apps"):
        for path in sorted((ROOT / folder).rglob("*")):
            inside = re.search(r"/finray/(ladder/|statics/|model/|benchmark/|estimation/row_curves)", str(path))
            if path.suffix in (".h", ".cc") and not inside and '"finray/ladder/' in path.read_text(encoding="utf-8"):
                yield f"{path.relative_to(ROOT)}: looks into ladder; statics/equilibrium.h is the face of the physics"


def box(x, y, width, name, words, ceres):
    fill = HEART if name == "residuals" else BOX
    mark = (f'<text x="{x + width - 10}" y="{y + 37}" text-anchor="end" font-size="12" fill="{CERES}">Ceres</text>'
            if ceres else "")
    return (f'<rect x="{x}" y="{y}" width="{width}" height="{ROW}" rx="5" fill="{fill}" stroke="{QUIET}"/>'
            f'<text x="{x + 12}" y="{y + 19}" font-size="16" font-weight="bold" fill="{INK}">{name}</text>'
            f'<text x="{x + 12}" y="{y + 37}" font-size="13" fill="{QUIET}">{words}</text>{mark}')


def picture(ceres):
    height = 2 * EDGE + len(ROWS) * (ROW + GAP) - GAP
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
           'font-family="sans-serif">',
           '<title>The rooms of finray, each above the rooms that it may use</title>',
           f'<rect width="{WIDTH}" height="{height}" rx="8" fill="{PAPER}" stroke="#d9dee4"/>']
    for i, row in enumerate(ROWS):
        y, free = EDGE + i * (ROW + GAP), WIDTH - 2 * EDGE - (len(row) - 1) * GAP
        letters = [max(len(words), len(name) + 8) for name, words in row]
        x = EDGE
        for (name, words), share in zip(row, letters):
            width = round(free * share / sum(letters))
            out.append(box(x, y, width, name, words, name in ceres))
            x += width + GAP
    out.append("</svg>")
    return "\n".join(out) + "\n"


def main():
    given = guard.words(__doc__, 0, 1)
    rooms, ceres = includes()
    found = [*faults(rooms), *late_stages(), *peeks()]
    print("\n".join(found), end="\n" if found else "")
    target = pathlib.Path(*given or [ROOT / "docs/pictures/layers.svg"])
    whole_file.write(target, picture(ceres))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

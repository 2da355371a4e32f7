#!/usr/bin/python3
"""The page of the outcomes: report.py OUT_DIR

Reads OUT_DIR/outcomes.json (evaluate.py); writes OUT_DIR/reality.html, which needs
nothing else, and OUT_DIR/tables.md.
"""

import json
import math
import pathlib
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("reality", __name__)

REPORT = pathlib.Path(__file__).resolve().parents[2] / "calib" / "report"
sys.path.append(str(REPORT))

import page
import whole_file
from theme import AFTER, BEFORE, QUIET, plt, svg

HELD_OUT = ("finger", "world", "plan", "verdict", "frames ok", "force rms (largest), N", "place rms (largest), mm",
            "force within 68 / 95 %", "place within 68 / 95 %", "unexplained", "second contact")


def error(values, digits):
    return f"{values['rms']:.{digits}f} ({values['max']:.{digits}f})"


def coverage(values):
    return f"{values['covered_68']:.0f} / {values['covered_95']:.0f}" if values["rms"] == values["rms"] else "none"


def held_out(outcomes):
    return [(o["finger"], o["world"], o["plan"], f"{o['verdict']}, exit {o['exit']}",
             f"{o['ok']} of {o['touched']}", error(o["force"], 3), error(o["place"], 2),
             coverage(o["force"]), coverage(o["place"]), str(o["unexplained"]), str(o["second"])) for o in outcomes]


# The paper's finger, measured: sections V-B, Figs. 11 and 12.
PAPER = ("the paper's", "measured", "", "0.58", "1.24", "0.15", "5")


def beside_the_paper(outcomes):
    return [PAPER] + [(o["finger"], o["world"], o["plan"], f"{o['means']['place_mm']:.2f}", f"{o['means']['angle_deg']:.2f}",
                       f"{o['means']['force_N']:.3f}", f"{o['means']['force_percent']:.1f}") for o in outcomes]


def fits(outcomes):
    return [(o["finger"], o["world"], o["plan"], *(f"{o['chi2_per_dof'][name]:.2f}" for name in ("gauge", "force", "object")),
             str(o["rejected"]), ", ".join(sorted(set(o["warnings"]))) or "none") for o in outcomes]


def short(value, std):
    """With two digits of the std."""
    return f"{value:.{max(0, 1 - math.floor(math.log10(std))) if std > 0 else 3}f}"


def parameters(outcomes):
    """A row a parameter: its true value, then value, std and error over std of each case; empty
    where a plan does not vary it."""
    body = []
    named = [{p["name"]: p for p in o["parameters"]} for o in outcomes]
    for name, first in {name: p for of in reversed(named) for name, p in of.items()}.items():
        row = [f"`{name}`", "" if first["true"] is None else f"{first['true']:.6g}"]
        for of in named:
            p = of.get(name)
            if p is None:
                row.append("")
                continue
            off = "" if p["true"] is None or not p["std"] > 0 else f", {(p['value'] - p['true']) / p['std']:+.1f} std"
            row.append(f"{short(p['value'], p['std'])} ± {short(p['std'], p['std'])}{off}")
        body.append(row)
    return body


def refusals(outcomes):
    return [(o["finger"], o["world"], o["plan"], o["refused"]) for o in outcomes if "refused" in o]


def tables(every):
    """(title, header, rows)."""
    outcomes = [o for o in every if "refused" not in o]
    found = [("Refused with exit code 2", ("finger", "world", "plan", "message"), refusals(every))] if refusals(every) else []
    found += [("The held-out log, from its gauges alone", HELD_OUT, held_out(outcomes)),
             ("Mean errors of the same frames, beside the paper's", ("finger", "world", "plan", "place, mm", "angle, deg",
                                                                     "force, N", "force, %"), beside_the_paper(outcomes)),
             ("The calibration", ("finger", "world", "plan", "chi2/dof gauges", "force", "object", "rejected frames",
                                  "warnings"), fits(outcomes))]
    for finger in dict.fromkeys(o["finger"] for o in outcomes):
        of = [o for o in outcomes if o["finger"] == finger]
        found.append((f"Calibrated parameters beside the true ones: {finger}",
                      ("parameter", "true", *(f"{o['world']}, {o['plan']}" for o in of)), parameters(of)))
    return found


def markdown(outcomes):
    text = []
    for title, header, body in tables(outcomes):
        text += [f"**{title}**", "", f"| {' | '.join(header)} |", f"|{'---|' * len(header)}",
                 *(f"| {' | '.join(row)} |" for row in body), ""]
    return "\n".join(text)


def plot(outcomes, kind, unit):
    """The share of held-out frames whose error is below a size, a line a world."""
    figure, axes = plt.subplots(figsize=(6.4, 2.6))
    for o, colour, marker in zip(outcomes, (QUIET, AFTER, BEFORE), "o^s"):
        size = sorted(abs(e) for e, _ in o["errors"][kind])
        shares = [100 * (i + 0.5) / len(size) for i in range(len(size))]
        axes.plot(size, shares, marker=marker, ms=3, lw=0.8, color=colour, label=o["world"])
    axes.set_xscale("log")
    axes.set_xlabel(f"error of {kind}, {unit}")
    axes.set_ylabel("frames below, %")
    axes.legend(loc="lower right")
    return svg(figure, f"Errors of {kind} of the held-out log")


def rendered(outcomes):
    environment = page.environment(pathlib.Path(__file__).parent)
    plots = []
    solved = [o for o in outcomes if "refused" not in o]
    for finger in dict.fromkeys(o["finger"] for o in solved):
        last = [o for o in solved if o["finger"] == finger]
        last = [o for o in last if o["plan"] == last[-1]["plan"] and o["errors"]["force"]]
        plots += [(plot(last, kind, unit), f"{finger}: {kind} of the held-out frames, plan `{last[-1]['plan']}`")
                  for kind, unit in (("force", "N"), ("place", "mm")) if last]
    return environment.get_template("reality.html.jinja").render(tables=tables(outcomes), plots=plots)


def main():
    folder = pathlib.Path(*guard.words(__doc__, 1, 1))
    try:
        outcomes = json.loads((folder / "outcomes.json").read_text("utf-8"))
    except (OSError, ValueError) as problem:
        print(f"report.py: {folder / 'outcomes.json'}: {problem}; evaluate.py writes it", file=sys.stderr)
        sys.exit(2)
    whole_file.write(folder / "tables.md", markdown(outcomes))
    whole_file.write(folder / "reality.html", rendered(outcomes))


if __name__ == "__main__":
    main()

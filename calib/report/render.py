#!/usr/bin/python3
"""Renders report.html of a calibration: render.py RESULT_FOLDER.

Reads calibration.yaml, calibration.frames.csv and calibration.shape.csv and
writes one self-contained page, plots inside as SVG.
"""

import csv
import datetime
import math
import os
import pathlib
import re
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts/common"))
import guard  # noqa: E402

guard.protect("render.py", __name__)

import jinja2

import page
import plots
import whole_file
from plots import known, number

MINUS = "\u2212"
WORST_FRAMES = 8
FAR_FROM_PRIOR = 4  # prior std; kFarFromPrior of analysis/unsupported.h


def read_csv(path):
    # Tables keep the bytes of names, which may be no UTF-8.
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        return list(csv.DictReader(file))


def missing(value):
    return value is None or isinstance(value, jinja2.Undefined) or (
        isinstance(value, float) and math.isnan(value))


def minus(text):
    return text.replace("-", MINUS)


def digits(value, std):
    """A value to the digits that its std leaves meaningful."""
    if missing(value):
        return "–"
    if std and math.isfinite(std):
        places = max(0, 1 - math.floor(math.log10(abs(std))))
        return minus(f"{value:.{places}f}")
    return minus(f"{value:.6g}")


def figures(value, count=3):
    """A number to so many significant figures, without an exponent where it can."""
    if missing(value):
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, (int, float)):
        return str(value)
    if math.isinf(value):
        return "∞" if value > 0 else MINUS + "∞"
    if value == 0 or isinstance(value, int):
        return minus(str(value))
    places = count - 1 - math.floor(math.log10(abs(value)))
    if places > 6 or abs(value) >= 1e6:
        return minus(f"{value:.{count - 1}e}")
    return minus(f"{value:.{max(0, places)}f}")


def two(value):
    return figures(value, 2)


def whole(value):
    return "–" if missing(value) else f"{value:.0f}"


def short(name):
    """The name without its unit: rib_1_length_mm, gauge_1_offset_V[a.csv]."""
    unit = r"_(N_mm2|V_per_rad|V_per_h|percent_per_K|V|mm|N)(?=$|\[)"
    return re.sub(unit, "", name).replace("_", " ").replace("[", " [")


def file_name(path):
    return os.path.basename(str(path))


def plural(count, word):
    return f"{count} {word}" + ("" if count == 1 else "s")


def far_from_prior(parameter):
    return abs(parameter.get("prior_stds_off", 0)) > FAR_FROM_PRIOR


def verdict(c):
    """The headline, what it means, and whether it is good."""
    statuses = [p["status"] for p in c["parameters"] if p["status"] != "fixed"]
    unknown = [short(p["name"]) for p in c["parameters"] if p["status"] == "unidentifiable"]
    by_prior = statuses.count("prior_dominated")
    if c["verdict"] == "not_converged":
        return "The solver did not converge.", "Do not use these values.", False
    if c["verdict"] == "unidentifiable":
        return (f"The logs do not determine {plural(len(unknown), 'parameter')}.",
                "Not to be used: " + ", ".join(unknown) + ".", False)
    if c["verdict"] == "doubtful":
        return "Doubtful: the model lacks something, or a stated noise is wrong.", "See the first warning.", False
    if c["verdict"] != "good":
        return c["verdict"].replace("_", " ").capitalize() + ".", "See the warnings below.", False
    text = f"All {len(statuses)} free parameters are determined."
    if by_prior:
        return text, f"Of {plural(by_prior, 'parameter')} the prior says more than the logs.", True
    return text, "The logs say more of each than its prior.", True


def tiles(c):
    """The figures that a reader asks for first: name, figure, note."""
    out = []
    errors = c.get("errors", {})
    part = "held_out" if "held_out" in errors else "fitted"
    after = errors.get(part, {}).get("after", {}).get("contact", {})
    before = errors.get(part, {}).get("before", {}).get("contact", {})
    where = "on held-out frames" if part == "held_out" else "on the frames that were fitted"
    if "force_rms_N" in after:
        note = f"{figures(after['force_rms_percent'], 2)} % rms {where}"
        if "force_rms_N" in before:
            note += f"; {figures(before['force_rms_N'], 2)} N before"
        out.append(("force error", f"{figures(after['force_rms_N'], 2)} N", note))
    if "contact_rms_mm" in after:
        out.append(("contact error", f"{figures(after['contact_rms_mm'], 2)} mm", f"rms {where}"))
    coverage = [after[k] for k in ("force_coverage_95_percent", "contact_coverage_95_percent")
                if k in after]
    if coverage:
        out.append(("95 % intervals cover", " / ".join(f"{v:.0f} %" for v in coverage),
                    "of force / contact errors" if len(coverage) == 2 else "of errors"))
    chi2 = sum(n["chi2"] for n in c["noise"].values())
    dof = sum(n["dof"] for n in c["noise"].values())
    if dof > 1:
        out.append(("χ² per degree of freedom", figures(chi2 / dof, 3),
                    "1 where noise is as the plan says"))
    return out


def regions(c):
    """Rows of the table by region: label, then per part after and before."""
    errors = c.get("errors", {})
    parts = [p for p in ("fitted", "held_out") if p in errors]
    rows = {}
    for part in parts:
        for kind in ("before", "after"):
            table = errors[part][kind]
            for region in table["regions"]:
                key = (region["from_mm"], region["to_mm"])
                cells = rows.setdefault(key, {}).setdefault(part, {"before": {}, "after": {}})
                cells[kind] = region
    named = [(f"{a:.0f} to {b:.0f} mm", cells) for (a, b), cells in sorted(rows.items())]
    whole = {part: {kind: errors[part][kind].get("contact", {}) for kind in ("before", "after")}
             for part in parts}
    if whole:
        named.append(("all", whole))
    return parts, named


def worst_frames(frames, gauges, force_std):
    """The frames that the model explains least, by their largest residual."""
    rows = []
    for f in frames:
        scores = []
        for j in range(gauges):
            value = number(f[f"gauge_{j + 1}_residual_std"])
            if known(value):
                scores.append((abs(value), f"gauge {j + 1}", value))
        error = number(f["force_after_N"]) - number(f["force_N"])
        std = number(f["force_after_std_N"])
        if known(error, std) and f["status_after"] == "ok":
            both = math.hypot(std, force_std)
            scores.append((abs(error) / both, "force from gauges", error / both))
        if scores:
            score, what, value = max(scores)
            rows.append({"log": file_name(f["log"]), "row": f["row"], "score": score, "what": what,
                         "value": value, "contact": number(f["contact_after_mm"]),
                         "reference": number(f["force_N"]), "force": number(f["force_after_N"]),
                         "std": std, "held_out": plots.held_out(f),
                         "status": f["status_after"]})
    return sorted(rows, key=lambda r: -r["score"])[:WORST_FRAMES]


def tables(value):
    """The content of a section of another tool, as (pairs, rows)."""
    pairs, rows = [], []
    if isinstance(value, dict):
        for key, item in value.items():
            if isinstance(item, list) and item and isinstance(item[0], dict):
                rows += item
            else:
                pairs.append((key.replace("_", " "), item))
    elif isinstance(value, list):
        rows = [v if isinstance(v, dict) else {"": v} for v in value]
    columns = list(dict.fromkeys(k for row in rows for k in row))
    return {"pairs": pairs, "columns": columns, "rows": rows}


def main():
    folder = pathlib.Path(sys.argv[1])
    c = page.load_yaml((folder / "calibration.yaml").read_text("utf-8"))
    frames = read_csv(folder / "calibration.frames.csv")
    gauges = sum(1 for p in c["parameters"] if "_gain_" in p["name"])
    environment = page.environment(undefined=jinja2.Undefined)
    environment.filters.update(figures=figures, two=two, whole=whole, short=short,
                               file_name=file_name)
    environment.globals.update(digits=digits, plural=plural, tables=tables,
                               far_from_prior=far_from_prior)
    parts, region_rows = regions(c)
    headline, meaning, good = verdict(c)
    names = c["correlations"]["names"]
    advice = [] if c["predicted_force"].get("enough") else c.get("next") or []
    forces, above = plots.forces(frames)
    text = environment.get_template("report.html.jinja").render(
        c=c, headline=headline, meaning=meaning, good=good, tiles=tiles(c),
        parts=parts, regions=region_rows, worst=worst_frames(frames, gauges, c["config"]["force_std_N"]),
        weak=[(w, plots.weak_direction(w["components"], short)) for w in c["weak_directions"]],
        frames={"contact": sum(f["kind"] == "contact" and plots.fitted(f) for f in frames),
                "free": sum(f["kind"] == "free" and plots.fitted(f) for f in frames),
                "held_out": sum(map(plots.held_out, frames))},
        forces=forces, above=above, heights=plots.errors_by_height(frames),
        shape=plots.shape(read_csv(folder / "calibration.shape.csv")),
        residuals=plots.residuals(frames, gauges) if gauges else None,
        coverage=plots.coverage(frames, advice),
        correlations=plots.correlations([short(n) for n in names], c["correlations"]["matrix"])
        if len(names) > 1 else None,
        date=datetime.date.today().isoformat())
    whole_file.write(folder / "report.html", text)


if __name__ == "__main__":
    main()

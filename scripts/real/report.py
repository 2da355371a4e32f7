#!/usr/bin/python3
"""Real measurements against predictions: report.py BUILD_DIR WORK_DIR PAGE PICTURES_DIR

Runs the command line tools of BUILD_DIR on ../shared/data and writes PAGE (Markdown)
and the pictures that it shows."""

import concurrent.futures
import pathlib
import sys
import textwrap

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("real_data", __name__)

import yaml

import bare_finger
import bench
import data
import gauged_finger
import outlines
import page_text
import pictures
from sums import rms
from tools import ROOT, Failed, Tools, write_yaml

sys.path.append(str(ROOT / "calib" / "report"))
import page
import whole_file

TITLE = """# Real measurements against predictions

Measured, not simulated: a steel finger (65Mn strips of 28 x 0.2 mm, 4 ribs, 2 gauges) of 2021. `scripts/real_data` writes this page and its pictures from
the measurements in `../shared/data`, beside the repository, with the command line tools alone; where they are absent it says so and leaves the page as it is. No row is
fitted and judged at once, but in the one table that says so: each figure says which rows were held out, and on how many it stands. rms of pins is that of a coordinate."""


def wrapped(text):
    """Lines of at most 160 characters, but for those of tables."""
    lines = []
    for line in text.split("\n"):
        if line.startswith(("|", "!", "#")):
            lines.append(line)
        else:
            lines += textwrap.wrap(line, 160, subsequent_indent="  " if line.startswith("- ") else "", break_long_words=False,
                                   break_on_hyphens=False) or [""]
    return "\n".join(lines)


def stem(words):
    return "".join(c if c.isalnum() else "_" for c in words)


def bare_part(tools, pool):
    series = bare_finger.all_series()
    circles = ("circle_r20", "circle_r30")

    def one(words):
        return bare_finger.trial(tools, f"bare/{stem(words)}", bare_finger.TRIALS[words], series, circles)[1]
    trials = dict(zip(bare_finger.TRIALS, pool.map(one, bare_finger.TRIALS)))
    chosen = min(trials, key=lambda words: bare_finger.score(
        [e for e in trials[words] if e["ribs"] and not bare_finger.superseded(e["log"])]))
    effects = bare_finger.TRIALS[chosen]
    fingers, entries = bare_finger.trial(tools, "bare/chosen", effects, series, tuple(bare_finger.SHAPE))
    out = [e for part in pool.map(lambda name: bare_finger.leave_advance_out(tools, f"bare/out/{name}", effects, series, name),
                                  bare_finger.SHAPE) for e in part]
    return series, trials, chosen, fingers, entries, out


def with_gauges(tools, finger):
    """The finger that the finger without gauges calibrated, with the gauges as given."""
    content = yaml.safe_load(finger.read_text("utf-8"))
    given = yaml.safe_load((data.FOLDER / "steel_finger.yaml").read_text("utf-8"))
    content.pop("calibration", None)
    del content["schema_version"]
    return write_yaml(tools.folder("gauged") / "stiffness_of_the_bare.yaml", {**content, "gauges": given["gauges"]})


def gauged_part(tools, pool, bare):
    rows = data.gauged()
    finger = data.FOLDER / "steel_finger.yaml"

    def one(job):
        words, parameters, keys, count = job
        return words, gauged_finger.leave_one_out(tools, f"gauged/{count}/{stem(words)}", bare if keys.get("bare") else finger, parameters, keys, rows[:count])
    jobs = [(*trial, count) for count in (len(rows), len(rows) - 1) for trial in gauged_finger.TRIALS]
    found = list(pool.map(one, jobs))
    explored = tools.explored("gauged/explore", finger, gauged_finger.plan(gauged_finger.PLAN, {}), {"r20": rows})
    return found[:len(gauged_finger.TRIALS)], found[len(gauged_finger.TRIALS):], explored


def limit(calibration):
    """The largest force of an estimate whose scene does not say it, 40 EI / l_0^2."""
    content = yaml.safe_load(calibration.finger.read_text("utf-8"))
    stiffness = (calibration.values["front_stiffness_N_mm2"] * calibration.values["back_stiffness_N_mm2"]) ** 0.5
    return 40 * stiffness / content["geometry"]["front_length_mm"] ** 2


def by_cylinders(tools, calibration, bent):
    """Rows of a table: forces of the finger whose gauges have the gains of a day's cylinders."""
    zero, *touching = data.gauged()
    gains = {entry["key"][:2]: entry["plain_gain"] for entry in bent}
    lines = []
    for day in sorted({day for name, day in gains if name == "fin_II"}):
        content = yaml.safe_load(calibration.finger.read_text("utf-8"))
        del content["schema_version"]
        content.pop("calibration", None)
        for j, (gauge, name) in enumerate(zip(content["gauges"], ("fin_I", "fin_II")), 1):
            # The same strain makes a gauge of another length turn more by its length.
            gauge.update(gain_V_per_rad=gains[name, day] * bench.LENGTH_MM / gauge["length_mm"], offset_V=float(zero[f"gauge_{j}_V"]))
        finger = write_yaml(tools.folder(f"by_cylinders/{day}") / "finger.yaml", content)
        log = [{key: cell for key, cell in row.items() if key.startswith("gauge_")} for row in touching]
        found = tools.estimate(f"by_cylinders/{day}", finger, {"contacts": 1, "force_max_N": gauged_finger.FORCE_MAX}, log)
        lines.append((day, *(f"{gauge['gain_V_per_rad']:.3f}" for gauge in content["gauges"]), len(log), f"{rms([float(at['normal_1_N']) - float(row['force_N']) for at, row in zip(found, touching)]):.2f}"))
    return lines


def directions(series):
    """Mean and largest difference of the force's direction between the days without ribs, deg."""
    first, second = ({row["advance_mm"]: row["sensor_deg"] for row in table}
                     for log, (_, ribs, table) in series.items() if not ribs)
    apart = [abs((first[at] - second[at] + 180) % 360 - 180) for at in first if at in second]
    return sum(apart) / len(apart), max(apart)


def main():
    build, work, target, shown = (pathlib.Path(argument).resolve() for argument in guard.words(__doc__, 4, 4))
    if not data.there():
        print(f"real_data: {data.FOLDER}: the measurements are not here; {target.name} stays as it is")
        return
    tools = Tools(build, work)
    try:
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            series, trials, chosen, fingers, entries, out = bare_part(tools, pool)
            print(f"finger without gauges: pins {rms(bare_finger.pin_errors(out, 2)):.2f} mm rms, an advance held out", flush=True)
            found, nine, explored = gauged_part(tools, pool, with_gauges(tools, fingers["circle_r20"].finger))
            print(f"finger with gauges: {gauged_finger.summary(found[0][1], 0)['rms']:.2f} N rms, a row held out", flush=True)
            cylinders = data.cylinders()
            bent = list(pool.map(lambda key: bench.judged(tools, "bench/" + stem(str(key)), key, cylinders), cylinders))
            print("bench done", flush=True)
        fitted = outlines.calibrated(tools)
        sprung = tools.calibrate("springs", data.FOLDER / "steel_finger.yaml", gauged_finger.plan(
            next(parameters for words, parameters, _ in gauged_finger.TRIALS if words == "+ springs at hinges"), {}),
            {"r20": data.gauged()})
        springs = [of["hinge_stiffness_N_mm_per_rad"] for of in (sprung.values, sprung.std)]
        shapes = outlines.judge(tools, fitted)
        cylinders_on_finger = by_cylinders(tools, fitted, bent)
    except (Failed, OSError) as error:
        print(f"real_data: {error}", file=sys.stderr)
        sys.exit(2)
    repeats = gauged_finger.repeatability(series)
    usable = gauged_finger.repeatability({log: of for log, of in series.items() if not bare_finger.superseded(log)})
    std, most, pairs = usable[("circle_r20", 4)]
    pictures.bare_forces(shown / "real_bare_forces.png", entries)
    pictures.bare_pins(shown / "real_bare_pins.png", out)
    pictures.gauged_forces(shown / "real_gauged_forces.png", found[0][1])
    pictures.outlines(shown / "real_outlines.png", dict(shapes["plain"])["zero reading of the day"],
                      shapes["corrected"][0][3], dict(shapes["irregular"])["no correction"],
                      dict(shapes["irregular"])["the place of the turning axis"])
    whole_file.write(target, wrapped("\n\n".join([
        TITLE, page_text.bare(trials, chosen, fingers, entries, out),
        page_text.gauged(found, nine, repeats, explored, f"{std:.2f} N and {most:.2f} N over {pairs} pairs",
                         limit(fitted), springs, cylinders_on_finger),
        page_text.benched(bent), page_text.touched(shapes), page_text.failures(trials, found, directions(series))])) + "\n")
    print(target)


if __name__ == "__main__":
    main()

"""Markdown of the sections: each takes results and returns text."""

import math

import bare_finger
import bench
import gauged_finger
from sums import rms


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def met(value, target):
    return "met" if value <= target else "missed"


def n(value, digits=2):
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def bare(trials, chosen, fingers, entries, rows_out):
    """trials: words -> entries of the circles; entries: all series with the chosen effects;
    rows_out: each advance held out."""
    text = ["## 1. The finger without gauges: shape and force from the place of an object", (
        "The finger is `steel_finger.yaml` without its gauges. `finray_calibrate` fits stiffness of both "
        "beams (drawing, 30 %), the place of each series and of the camera, and what a trial adds. `finray_simulate` predicts the rows that were "
        "held out. A click on a pin is good to 0.5 to 0.7 mm. Two ways of holding out:\n\n"
        "- **an advance**: all rows of an object at this advance, forces and pins, are predicted by what its other advances calibrate;\n"
        "- **an object**: all rows of an object are predicted by the finger that another object calibrates (R = 20 mm by R = 30 mm, all others by "
        "R = 20 mm). The place of the object is then either as written, beside the mean origin of the other object's series, or comes from the "
        "other rows of its own series, with the row itself held out. The finger has seen no row of the object in either case.")]
    pins, forces = bare_finger.pin_errors(rows_out, 2), bare_finger.force_errors(rows_out, 2)
    by_object = [e for e in entries if e["ribs"] and not bare_finger.superseded(e["log"])]
    others = bare_finger.pin_errors(entries, 2)
    text.append(
        f"**Pins, an advance held out: {rms(pins):.2f} mm rms** of a coordinate over {len(pins) // 2} pins of 18 images; "
        f"the target of 0.7 mm is {met(rms(pins), 0.7)}. An object held out: {rms(others):.2f} mm over {len(others) // 2} pins, "
        f"{met(rms(others), 0.7)}. About the mean error of each image, which is how well the image was laid on frame S, "
        f"{rms(bare_finger.about_the_image(rows_out, 2)):.2f} and {rms(bare_finger.about_the_image(entries, 2)):.2f} mm are left: images differ by about "
        f"0.5 mm as a whole, and no model of a finger can know that. "
        "The effects were chosen by the trials below, in which one circle predicts the other; the ellipse and the ribless finger had no say in it.")
    text.append("**An advance held out**, effects: " + chosen + "\n\n" + table(
        ("object", "force rows", "force, N rms", "pins", "pins, mm rms", "about the image, mm"),
        [(name, len(bare_finger.force_errors(mine, 2)), n(rms(bare_finger.force_errors(mine, 2))),
          len(bare_finger.pin_errors(mine, 2)) // 2, n(rms(bare_finger.pin_errors(mine, 2))), n(rms(bare_finger.about_the_image(mine, 2))))
         for name in (*bare_finger.SHAPE, "all") for mine in [[e for e in rows_out if name in ("all", e["object"])]]]))
    rows = []
    for log in dict.fromkeys(e["log"] for e in entries):
        mine = [e for e in entries if e["log"] == log]
        written, located, pins_written, pins_located, image = bare_finger.line(mine)
        largest = max((e["force"][0] for e in mine if "force" in e), default=math.nan)
        rows.append((log.replace("_", " "), bare_finger.TRAINED_BY[mine[0]["object"]].replace("_", " "), len(mine), n(largest, 1), n(written),
                     n(located), n(pins_written), n(pins_located), n(image)))
    text.append("**An object held out**, every series (all 55 force rows and all 144 pins)\n\n" + table(
        ("series", "finger by", "rows", "largest force, N", "force, place as written, N rms", "force, place by the other rows", "pins, place as written, mm rms",
         "pins, place by the other images", "about the image"), rows))
    ribless = [e for e in entries if not e["ribs"]]
    last = [e for e in by_object if e["log"] == "circle_r20_4_ribs_2021-05-20_3"]
    slope = [(last[k + 1]["force"][0] - last[k]["force"][0]) / (last[k + 1]["advance_mm"] - last[k]["advance_mm"]) for k in (0, len(last) - 2)]
    light = [e for e in by_object if "force" in e and e["object"].startswith("ellipse") and e["advance_mm"] <= 20]
    heavy = [e for e in by_object if "force" in e and e["object"].startswith("ellipse") and e["advance_mm"] > 20]
    text.append(
        f"- Without ribs the same beams carry a circle: {len(ribless)} rows of two days, to 55 mm of advance, are predicted within "
        f"{rms(bare_finger.force_errors(ribless, 1)):.2f} N rms by stiffnesses that only the finger with ribs has shown. Nothing of them was fitted.\n"
        f"- The place as written costs most: series were touched off by hand, about 1 mm apart, and on R = 20 mm 1 mm is {slope[0]:.1f} N at light and {slope[1]:.1f} N at deep touches.\n"
        f"- The ellipse to 20 mm of advance: {rms(bare_finger.force_errors(light, 1)):.2f} N rms on {len(light)} rows, place as written; beyond, where the "
        f"model has two contacts, {rms(bare_finger.force_errors(heavy, 1)):.2f} N on {len(heavy)} rows of up to {max(e['force'][0] for e in heavy):.1f} N. Its pins lie 1 to 2 mm behind its "
        "forces: the two series were touched off apart.\n"
        "- The first ellipse's advances are moved by 5 mm, as its author's header is marked uncertain: so it agrees with the second within 0.1 N at the advance that both have (repeatability, section 2).\n"
        "- The first series on R = 20 mm is marked superseded. It is predicted, but calibrates nothing.")
    text.append("![measured and predicted forces over the advance](../pictures/real_bare_forces.png)\n\n"
                "![pins: camera and prediction](../pictures/real_bare_pins.png)")
    text.append(parameters(fingers, ("front_stiffness_N_mm2", "back_stiffness_N_mm2")))
    rows = []
    for words, found in trials.items():
        mine = [e for e in found if e["ribs"] and not bare_finger.superseded(e["log"])]
        rows.append((("**" + words + "**" if words == chosen else words), n(bare_finger.score(mine), 0), *map(n, bare_finger.line(mine)),
                     n(rms(bare_finger.force_errors([e for e in found if not e["ribs"]], 1)))))
    text.append(
        "**Trials: what else is free.** One circle predicts the other (19 force rows, 96 pins); the score is the sum of squares over 0.3 N and 0.6 mm, the place from the "
        "other rows of the series, and the lowest one chooses. The last column, ribless fingers, is not in the score.\n\n" + table(
            ("free beside stiffness and places", "score", "force, place as written, N", "force, place by other rows, N", "pins, as written, mm",
             "pins, by other images, mm", "about the image, mm", "no ribs, as written, N"), rows))
    return "\n\n".join(text)


def parameters(fingers, names):
    return "**Calibrated stiffness**\n\n" + table(("parameter", *(f"by {name.replace('_', ' ')}" for name in fingers)), [
        (f"`{name}`", *(f"{c.values[name]:.0f} +- {c.std[name]:.0f}" for c in fingers.values())) for name in names])


def gauged(found, nine, repeats, explored, outliers, limit, springs, by_cylinders):
    """found, nine: [(words, entries)] of all rows with contact, and without the heaviest."""
    best, best_place = (min((gauged_finger.summary(e, which)["rms"], words) for words, e in found) for which in (0, 1))
    best_nine = min((gauged_finger.summary(e, 0)["rms"], words) for words, e in nine)
    plan, plan_nine = found[0][1], nine[0][1]

    def gains(trials):
        return {w: gauged_finger.log_likelihood(e, 0) - gauged_finger.log_likelihood(trials[0][1], 0) for w, e in trials}
    preferred = sorted(((gain, w) for w, gain in gains(found).items() if gain >= 2), reverse=True)
    preferred_nine = [(gains(nine)[w], w) for _, w in preferred]
    s, p, s9, p9 = (gauged_finger.summary(e, which) for e in (plan, plan_nine) for which in (0, 1))
    force, (sensed, std, _), _ = plan[-1]
    steps = [row[0] for row in plan]

    def row(words, entries, which):
        r = gauged_finger.summary(entries, which)
        return (words, r["rows"], n(r["rms"]), n(r["log_likelihood"], 1), f"{r['within_68']} / {r['within_95']}", r["unobservable"])

    text = ["## 2. The finger with gauges: force from two gauges", (
        "`steel_finger_contact_circle_r20.csv` has one zero reading and ten rows with contact. Each of the ten is left out in turn: `finray_calibrate` has the other "
        "rows, `finray_estimate` then senses the row's force from its gauges, alone or with the place of the circle (`object_std_mm: 1`, which is what is known of it). "
        "The intervals contain 0.1 N of the reference."),
        f"**Gauges alone: {s['rms']:.2f} N rms over {s['rows']} rows** by the bundled plan; with the place of the circle {p['rms']:.2f} N. The target of 0.3 N is "
        f"{met(s['rms'], 0.3)}. Without the heaviest row, in the calibrations too: {s9['rms']:.2f} N alone ({met(s9['rms'], 0.3)}) and **{p9['rms']:.2f} N with the place** "
        f"({met(p9['rms'], 0.3)}) over {s9['rows']} rows; of these {s9['within_68']} and {s9['within_95']}, with the place {p9['within_68']} and {p9['within_95']} lie within 68 and 95 % intervals.",
        "Why the heaviest row counts apart, and what the data allow:\n\n"
        f"- The other nine rows sense {sensed:.2f} +- {std:.2f} N there; the sensor reads {force:.2f} N, {abs(sensed - force) / math.hypot(std, 0.1):.1f} std away. "
        f"From row to row the force grew by {', '.join(f'{b - a:.2f}' for a, b in zip(steps[-5:-1], steps[-4:-1]))} N and the last time by {steps[-1] - steps[-2]:.2f} N, while the gauges went on as before. "
        "A contact that slips, or a sensor near its end, does that; the row alone cannot tell. While it is in the calibration the two rows below it are "
        f"{', '.join(f'{e:+.2f}' for e in gauged_finger.errors(plan, 0)[-3:-1])} N off, without it {', '.join(f'{e:+.2f}' for e in gauged_finger.errors(plan_nine, 0)[-2:])} N.\n"
        f"- No trial of the table brings all ten rows below {best[0]:.2f} N ({best[1]}) from gauges alone, or below {best_place[0]:.2f} N ({best_place[1]}) with the place.\n"
        f"- The likelihood of held-out rows prefers {' and '.join(f'{w[2:]} ({gain:+.1f})' for gain, w in preferred)} to the bundled plan; springs come out at {springs[0]:.0f} +- {springs[1]:.0f} N mm/rad. "
        f"Without the heaviest row they gain {', '.join(f'{w[2:]} {gain:+.1f}' for gain, w in preferred_nine)}, and on the finger without gauges, where 96 pins would show them, nothing (section 1). "
        "They lean on that one row, so that the plan stays as it is.\n"
        f"- Of {len(nine)} trials without the heaviest row the best has {best_nine[0]:.2f} N from gauges alone ({best_nine[1]}); it was picked by looking, so that {s9['rms']:.2f} N of the plan that was there before is the figure to trust.\n"
        "- At light touches (the first four rows) the two gauges do not tell where the contact is: these rows are `unobservable` "
        "from gauges alone and say so with std of 1 to 3 N, and the place settles them.",
        "Repeatability, from the data themselves: pairs of series of the finger without gauges at the same advance (standard deviation of one of the two; largest difference)\n\n" + table(
            ("object", "ribs", "pairs", "std of one, N", "largest difference, N"),
            [(kind[0].replace("_", " "), kind[1], pairs, n(std), n(most)) for kind, (std, most, pairs) in repeats.items()]) +
        "\n\nOn R = 20 mm this has the superseded series in; without it, " + outliers + ". A force of 0.3 N rms is thus at the edge of what one series can confirm.",
        "![force of each held-out row](../pictures/real_gauged_forces.png)",
        "**Trials, gauges alone, ten rows** (log-likelihood of the held-out rows; `unobservable` rows are in)\n\n" + table(
            ("plan", "rows", "rms, N", "log-likelihood", "within 68 / 95 %", "unobservable"), [row(w, e, 0) for w, e in found]),
        "**Trials, gauges and place, ten rows**\n\n" + table(("plan", "rows", "rms, N", "log-likelihood", "within 68 / 95 %", "unobservable"), [row(w, e, 1) for w, e in found]),
        "**Trials without the heaviest row**\n\n" + table(
            ("plan", "rows", "gauges alone, rms, N", "log-likelihood", "with the place, rms, N", "log-likelihood"),
            [(w, len(e), n(a["rms"]), n(a["log_likelihood"], 1), n(b["rms"]), n(b["log_likelihood"], 1)) for w, e in nine
             for a, b in [(gauged_finger.summary(e, 0), gauged_finger.summary(e, 1))]]),
        f"`finray_calibrate --explore` on all rows: {explored}.",
        f"**Say `force_max_N`.** Every scene and plan of this section has `force_max_N: {gauged_finger.FORCE_MAX}`. Without it an estimate goes no further than 40 EI / l_0^2, "
        f"{limit:.1f} N of this finger, which carries {force:.1f} N: {sum(step > limit for step in steps)} rows end at the bound, are `unobservable`, and a calibration judges its forces without them. "
        "It warns of that now (`forces_beyond_limit`).",
        "**Gains of the cylinders instead**: fin_I as gauge 1, fin_II as gauge 2, gains as fitted in section 3 without a curve and for the shorter gauge, stiffness of the bundled plan's calibration, offsets by the zero reading. "
        "These ten forces calibrated no gain, though the stiffness has seen them.\n\n" + table(("day of the cylinders", "gain 1, V/rad", "gain 2", "rows", "force, N rms"), by_cylinders)]
    return "\n\n".join(text)


def benched(entries):
    total = bench.totals(entries)

    def pair(how):
        (plain, count), (curved, _) = total["plain" + how], total["curved" + how]
        return f"{1e3 * plain:.1f} mV with one gain, {1e3 * curved:.1f} mV with a curve ({count} readings)"
    rows = [(f"{e['key'][0]}, {e['key'][1]}, {e['key'][2]}", e["rows"], n(e["gauge"][0], 3), n(e["gauge"][1]), *(n(1e3 * rms(e[k]), 1) for k in (
        "plain", "curved", "plain_same_day", "curved_same_day", "plain_other_day", "curved_other_day"))) for e in entries]
    days = {name: [e["gauge"][0] for e in entries if e["key"][0] == name] for name in ("fin_I", "fin_II")}
    better = sum(rms(e["curved"]) < rms(e["plain"]) for e in entries)
    return "\n\n".join([
        "## 3. Gauges on the bench: what a curve is worth",
        "`gauge_cylinder_calibration.csv`, readings that their author did not exclude. Gauges are 38 mm long; the plan frees gain and offset, then `gauge_curvature` too. Three ways of holding out, "
        "each rms of readings that calibrated nothing:\n\n"
        f"- one cylinder of a series by the others, ends included, which are extrapolated: {pair('')}; the curve is better in {better} of {len(entries)} series;\n"
        f"- the second series of a day by the first and back, offset by its flat reading: {pair('_same_day')};\n"
        f"- a series of another day, offset by its flat reading: {pair('_other_day')}.\n\n"
        "So the curve belongs to the gauge: on the same day it removes most of the error. From day to day the gain itself changes, " + " and ".join(f"{name} from {min(gains):.2f} to {max(gains):.2f} V/rad" for name, gains in days.items()) + ", with "
        "mounting and amplifier, and the curve is small beside that. Gains of the bench cannot be taken to the finger of another day (last table of section 2).",
        table(("gauge, day, trial", "rows", "gain, V/rad", "curvature, 1/rad", "left out, one gain, mV rms", "curve", "same day, one gain", "curve", "other day, one gain", "curve"), rows)])


def touched(found):
    plain, corrected = dict(found["plain"]), found["corrected"]
    today = plain["zero reading of the day"]

    def row(words, shape, *more):
        if shape.refused:
            return (words, *more, "refused: " + shape.refused, "", "", "", "", "", "")
        return (words, *more, f"{shape.used} of {shape.rows}", n(shape.circumference, 1), n(shape.radius), n(shape.off), n(shape.std), n(shape.noise), n(shape.force, 1))

    header = ("touches used", "circumference, mm", "mean radius, mm", "rms from R = 30 mm", "mean std, mm", "noise, times expected", "mean force, N")
    place = [(half, by, shape) for name, half, by, shape in corrected if name == "the place of the turning axis"]
    moved = [by.values[f"object_origin_{axis}_mm"] for axis in "xy" for _, by, _ in place]
    shapes = [shape for _, _, shape in place]
    gains, offsets = found["gains"], found["offsets"]
    used = dict(found["irregular"])
    return "\n\n".join([
        "## 4. Real touches: outlines",
        "The finger is that of section 2, calibrated on all rows of R = 20 mm. Offsets are the zero reading of the log's first row. The circle of R = 30 mm (circumference 188.5 mm) calibrated nothing in the first table.",
        table(("circle, as written", *header), [row(words, shape) for words, shape in found["plain"]]),
        f"**The outline is round but short**: {today.circumference:.1f} mm instead of 188.5. The gauges say why only in part. By the place that the circle asks for below the finger is bent as by 4 mm less of advance "
        f"than is written, and 18 touches at one pose are two numbers, one a gauge. The known circle can therefore correct one pair of parameters. Half of the touches (every other one) "
        "calibrate that pair, with R known and no force; the other half is reconstructed:",
        table(("calibrated by half of the touches", "half", *header), [row(name, shape, half) for name, half, _, shape in corrected]),
        f"- Moving the turning axis by ({(moved[0] + moved[1]) / 2:.1f}, {(moved[2] + moved[3]) / 2:.1f}) mm gives {shapes[0].circumference:.1f} and {shapes[1].circumference:.1f} mm on the halves that were held out, "
        f"{shapes[0].off:.2f} and {shapes[1].off:.2f} mm rms from the circle, and the noise is no more than expected.\n"
        f"- Other gains ({', '.join(f'{100 * (value / before - 1):+.0f}' for value, before in gains)} %) or other offsets ({', '.join(f'{1e3 * value:+.0f}' for value in offsets)} mV) do the same. "
        "The circle alone does not tell these apart: gains changed by more between days (section 3), the zero reading of gauge 2 differs by 40 mV between the three logs, and the place of the axis is inferred, "
        "though to 1 to 2 mm. Stiffness does not explain it: its calibration is `unexplained`.\n"
        f"- The irregular object does not settle it. With gains or offsets of the circle most of its touches become `unobservable` (table below); with the place they stay, but the noise of its outline grows from "
        f"{used['no correction'].noise:.2f} to {used['the place of the turning axis'].noise:.2f} times the expected one. So no correction of the circle is shown to hold for another log. What a user can do: touch a known circle in the same session, and let it "
        "calibrate the place (`object_origin`) before the unknown object.\n"
        f"- The centre of the outline is ({today.centre[0]:.1f}, {today.centre[1]:.1f}) mm from the axis; the circle turned about a point {math.hypot(*today.centre):.1f} mm beside its centre, or the readings drifted.",
        "**The irregular object**, by the correction that all touches of the circle give; offsets by its own zero reading\n\n" + table(("correction", *header[:3], *header[4:]), [
            (lambda r: (*r[:4], *r[5:]))(row(words, shape)) for words, shape in found["irregular"]]),
        f"Nobody measured this object, so that only the fit judges: the sense of turning that the notes infer leaves {n(used['the place of the turning axis'].noise)} times the expected noise, "
        f"the other one {n(used['the place of the turning axis, the other sense'].noise)} times. Its last row repeats 0 degrees: gauges differ by {found['repeat'][0]:.0f} and {found['repeat'][1]:.0f} mV.",
        "![outlines of the circle and of the irregular object](../pictures/real_outlines.png)"])


def failures(trials, found, directions):
    score = {words: bare_finger.score([e for e in e_ if e["ribs"] and not bare_finger.superseded(e["log"])]) for words, e_ in trials.items()}
    first = score["stiffness, places"]
    useless = [f"{words} ({value:.0f})" for words, value in score.items() if value > first - 12 and words != "stiffness, places"]
    plan = gauged_finger.summary(found[0][1], 0)
    worse = [f"{words.lstrip('+ ')} ({n(s['rms'])} N)" for words, e in found[1:] for s in [gauged_finger.summary(e, 0)]
             if s["log_likelihood"] < plan["log_likelihood"] + 2]
    return "\n\n".join(["## 5. Tried without success", "\n".join([
        f"- Finger without gauges, score of the held-out circle no better than {first:.0f} of stiffness and places by 12: {', '.join(useless)}.",
        f"- Finger with gauges, log-likelihood of held-out rows from gauges alone better than the bundled plan's by less than 2 ({n(plan['rms'])} N): {', '.join(worse)}.",
        "- Gains of the cylinders for the finger of another day (section 3).",
        f"- The direction of the force, by `sensor_axis_angle_deg`: for the same touches without ribs the two days differ by {directions[0]:.0f} deg on average and {directions[1]:.0f} deg at most, so that it can tell neither friction nor normals. "
        "All forces of this page are norms.",
        "- A calibration of all objects at once: a plan has one circle. The ellipse calibrates as the circle of its curvature, R = 45 mm.",
        "- Telling place, gains and offsets apart by the turning circle (section 4)."])])

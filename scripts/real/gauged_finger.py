"""The finger with gauges: each row's force from its gauges by what the other rows calibrate."""

import math

import data
from sums import rms
from tools import number

FORCE_STD, FORCE_MAX = 0.1, 25
STIFFNESS = {"front_stiffness": {"prior_std_percent": 10}, "back_stiffness": {"prior_std_percent": 10}}
GAUGES = {"gauge_gain": {"prior_std_percent": 50}, "gauge_offset": {"prior_std_V": 0.05}}
PLAN = {**STIFFNESS, **GAUGES}  # configs/plans/two_gauges_circle_r20.yaml
# (words, parameters, keys of the plan or of the log).
TRIALS = [
    ("the bundled plan", PLAN, {}),
    ("stiffness fixed", GAUGES, {}),
    ("stiffness to 30 %", {**GAUGES, "front_stiffness": {"prior_std_percent": 30}, "back_stiffness": {"prior_std_percent": 30}}, {}),
    ("stiffness from the finger without gauges", GAUGES, {"bare": True}),
    ("+ origin of the stage, place to 0.3 mm", {**PLAN, "object_origin": {"prior_std_mm": 2}}, {"object_std_mm": 0.3}),
    ("+ turn of the stage", {**PLAN, "object_rotation": {"prior_std_deg": 1}}, {}),
    ("+ radius of the circle", {**PLAN, "object_radius": {"prior_std_mm": 0.5}}, {}),
    ("+ curved gain of the gauges", {**PLAN, "gauge_curvature": {"prior_std_per_rad": 1}}, {}),
    ("+ places of the gauges", {**PLAN, "gauge_start": {"prior_std_mm": 1}}, {}),
    ("+ friction", {**PLAN, "friction": {"prior_std": 0.3}}, {}),
    ("+ springs at hinges", {**PLAN, "hinge_stiffness": {"prior_std_N_mm_per_rad": 20}}, {}),
    ("+ rib lengths", {**PLAN, "rib_length": {"prior_std_mm": 0.5}}, {}),
    ("+ places of hinges", {**PLAN, "hinge_place": {"prior_std_mm": 0.5}}, {}),
    ("+ clamps that turn", {**PLAN, "clamp_compliance": {"prior_std_rad_per_N_mm": 1e-4}}, {}),
    ("+ pieces of the beams", {**PLAN, "stiffness_pieces": {"prior_std_percent": 20, "count": 3}}, {}),
    ("+ offset of the force", {**PLAN, "force_offset": {"prior_std_N": 0.2}}, {}),
    ("rib pins, origin of the camera", {**PLAN, "camera_origin": {"prior_std_mm": 2}}, {"pin_std_mm": 0.6}),
    ("Huber's loss at 1.5 std", PLAN, {"loss": {"type": "huber", "scale": 1.5}}),
    ("force to 0.3 N", PLAN, {"force_std_N": 0.3}),
]


def with_pins(log):
    """The log, with the pins of the same advance."""
    pins = {row["object_x_mm"]: row for row in data.gauged_pins()}
    return [{**row, **{key: cell for place, seen in pins.items() if abs(place - float(row["object_x_mm"])) < 0.6
                       for key, cell in seen.items() if key.startswith("rib_")}} for row in log]


def plan(parameters, keys):
    measured = {"force_std_N": keys.get("force_std_N", FORCE_STD), "gauge_std_V": 0.006,
                "object_std_mm": keys.get("object_std_mm", 1.0)}
    if "pin_std_mm" in keys:
        measured["pin_std_mm"] = keys["pin_std_mm"]
    found = {"scene": {"contacts": "auto", "object": {"shape": "circle", "radius_mm": 20}, "force_max_N": FORCE_MAX},
             "parameters": parameters, "measurements": measured}
    return {**found, "robust_loss": keys["loss"]} if "loss" in keys else found


def sensed(tools, folder, calibration, row, place_std=None):
    """Force and std of a row from its gauges, with place_std from the object's place too."""
    values = calibration.values
    friction = values.get("friction_coefficient", 0.0)
    scene = {"contacts": 1, "friction_coefficient": friction, "force_max_N": FORCE_MAX}
    log = {key: cell for key, cell in row.items() if key.startswith("gauge_")}
    if place_std:
        scene.update(object={"shape": "circle", "radius_mm": 20}, measurements={"object_std_mm": place_std})
        log.update({f"object_{axis}_mm": float(row[f"object_{axis}_mm"]) + values.get(f"object_origin_{axis}_mm", 0.0)
                    for axis in "xy"})
    found = tools.estimate(folder, calibration.finger, scene, [log])[0]
    size = math.hypot(1, friction)
    return (size * number(found["normal_1_N"]) + values.get("force_offset_N", 0.0), size * number(found["normal_1_std_N"]),
            found["status"])


def leave_one_out(tools, folder, finger, parameters, keys, rows):
    """Rows with contact: measured force, (force, std, status) from gauges alone, and with
    the object's place."""
    log = with_pins(rows) if "pin_std_mm" in keys else rows
    found = []
    for k, row in enumerate(rows):
        if not row["force_N"]:
            continue
        calibration = tools.calibrate(folder, finger, plan(parameters, keys), {"others": log[:k] + log[k + 1:]})
        found.append((float(row["force_N"]), sensed(tools, folder, calibration, row),
                      sensed(tools, folder, calibration, row, keys.get("object_std_mm", 1.0))))
    return found


def errors(entries, which):
    return [entry[1 + which][0] - entry[0] for entry in entries]


def stds(entries, which, reference):
    return [math.hypot(entry[1 + which][1], reference) for entry in entries]


def covered(entries, which, reference, width):
    return sum(abs(e) < width * s for e, s in zip(errors(entries, which), stds(entries, which, reference)))


def log_likelihood(entries, which, reference=FORCE_STD):
    return sum(-0.5 * (e / s) ** 2 - math.log(s) for e, s in zip(errors(entries, which), stds(entries, which, reference)))


def summary(entries, which):
    return {"rows": len(entries), "rms": rms(errors(entries, which)), "log_likelihood": log_likelihood(entries, which),
            "within_68": covered(entries, which, FORCE_STD, 1), "within_95": covered(entries, which, FORCE_STD, 1.96),
            "unobservable": sum(entry[1 + which][2] != "ok" for entry in entries)}


def repeatability(series):
    """Pairs of repeats of the finger without gauges at the same advance: standard
    deviation of one of them, by kind, with the number of pairs."""
    found = {}
    names = sorted(name for name, (_, _, rows) in series.items() if "force_N" in rows[0])
    for k, first in enumerate(names):
        for second in names[k + 1:]:
            if series[first][:2] != series[second][:2]:
                continue
            others = {row["advance_mm"]: row["force_N"] for row in series[second][2]}
            for row in series[first][2]:
                if row["advance_mm"] in others:
                    found.setdefault(series[first][:2], []).append(row["force_N"] - others[row["advance_mm"]])
    return {kind: (rms(pairs) / math.sqrt(2), max(map(abs, pairs)), len(pairs)) for kind, pairs in found.items()}

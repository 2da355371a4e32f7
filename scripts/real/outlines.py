"""Touches of turning objects: outlines, and what brings the circle to its size."""

import math

import yaml

import data
import gauged_finger
from sums import mean, rms
from tools import number, rows, run, write_table, write_yaml

RADIUS_MM = 30
CORRECTIONS = {
    "the place of the turning axis": {"object_origin": {"prior_std_mm": 5}},
    "the gains of the gauges": {"gauge_gain": {"prior_std_percent": 30}},
    "the offsets of the gauges": {"gauge_offset": {"prior_std_V": 0.05}},
    "the stiffness of both beams": {"front_stiffness": {"prior_std_percent": 30}, "back_stiffness": {"prior_std_percent": 30}},
}


def zeroed(tools, folder, finger, zero, moved=(0.0, 0.0)):
    """The finger with the offsets of a zero reading, moved by so many V."""
    content = yaml.safe_load(finger.read_text("utf-8"))
    del content["schema_version"]
    for j, gauge in enumerate(content["gauges"]):
        gauge["offset_V"] = float(zero[f"gauge_{j + 1}_V"]) + moved[j]
    return write_yaml(tools.folder(folder) / "zeroed.yaml", content)


def correct(tools, folder, finger, parameters, touches):
    """What the known circle says of a finger of known stiffness: no force, no turn."""
    plan = {"scene": {"contacts": 1, "object": {"shape": "circle", "radius_mm": RADIUS_MM},
                      "force_max_N": gauged_finger.FORCE_MAX},
            "parameters": parameters, "measurements": {"gauge_std_V": 0.006, "object_std_mm": 0.1}}
    return tools.calibrate(folder, finger, plan,
                           {"circle": [{k: c for k, c in row.items() if k != "object_angle_deg"} for row in touches]})


class Outline:
    """What finray_reconstruct makes of touches whose axis stands beside where it is
    written; sense -1 turns the object the other way."""

    def __init__(self, tools, name, finger, touches, place=(0.0, 0.0), sense=1):
        self.folder = tools.folder(name)
        table = [{**row, "object_x_mm": float(row["object_x_mm"]) + place[0],
                  "object_y_mm": float(row["object_y_mm"]) + place[1],
                  "object_angle_deg": sense * float(row["object_angle_deg"])} for row in touches]
        ended = run(tools.build, "finray_reconstruct", "--finger", finger, "--scene",
                    write_yaml(self.folder / "scene.yaml", {"contacts": 1, "force_max_N": gauged_finger.FORCE_MAX}),
                    "--logs", write_table(self.folder / "touches_in.csv", table), "--noplots", "--out_dir", self.folder,
                    allowed=(0, 2, 4))
        self.rows = len(table)
        self.refused = ended.stderr.strip().splitlines()[-1].split(".csv: ")[-1] if ended.returncode else ""
        if self.refused:
            return
        content = yaml.safe_load((self.folder / "reconstruction.yaml").read_text("utf-8"))
        outline = rows(self.folder / "outline.csv")
        self.points = [(number(row["x_mm"]), number(row["y_mm"])) for row in outline]
        self.std = mean([number(row["std_mm"]) for row in outline])
        found = rows(self.folder / "touches.csv")
        self.contacts = [(number(row["point_x_mm"]), number(row["point_y_mm"])) for row in found]
        self.force = mean([number(row["normal_N"]) for row in found])
        self.used, self.noise = len({row["row"] for row in found}), content["fit"]["noise_scale"]
        self.centre = content["centroid_mm"]
        self.circumference = sum(math.dist(a, b) for a, b in zip(self.points, self.points[1:] + self.points[:1]))
        radii = [math.hypot(*point) for point in self.points]
        self.radius, self.off = mean(radii), rms([r - RADIUS_MM for r in radii])
        # About its own centre: is it round?
        own = [math.dist(point, self.centre) for point in self.points]
        self.round = rms([r - mean(own) for r in own])


def judge(tools, calibration):
    """calibration: on the circle of 20 mm."""
    finger = calibration.finger
    zero, *circle = data.touches("circle_r30")
    first, *irregular = data.touches("irregular")
    ready = zeroed(tools, "circle", finger, zero)
    other_day = zeroed(tools, "irregular", finger, first)
    found = {"plain": [("offsets of the calibration", Outline(tools, "unzeroed", finger, circle)),
                       ("zero reading of the day", Outline(tools, "zeroed", ready, circle)),
                       ("the other sense of turning", Outline(tools, "sense", ready, circle, sense=-1)),
                       ("the finger as given, zeroed", Outline(tools, "given", zeroed(tools, "given", data.FOLDER / "steel_finger.yaml", zero), circle))],
             "corrected": [], "irregular": [("no correction", Outline(tools, "irregular", other_day, irregular))]}
    for name, parameters in CORRECTIONS.items():
        folder = name.replace(" ", "_")
        for half in (0, 1):
            by = correct(tools, f"{folder}/{half}", ready, parameters, circle[half::2])
            place = [by.values.get(f"object_origin_{axis}_mm", 0.0) for axis in "xy"]
            found["corrected"].append((name, ("even", "odd")[half], by, Outline(
                tools, f"{folder}/{half}/outline", by.finger, circle[1 - half::2], place)))
        every = correct(tools, f"{folder}/all", ready, parameters, circle)
        place = [every.values.get(f"object_origin_{axis}_mm", 0.0) for axis in "xy"]
        moved = [every.values[f"gauge_{j}_offset_V"] - float(zero[f"gauge_{j}_V"]) if "gauge_offset" in parameters else 0.0
                 for j in (1, 2)]
        same = zeroed(tools, f"{folder}/all/irregular", every.finger, first, moved)
        found["irregular"].append((name, Outline(tools, f"{folder}/all/irregular", same, irregular, place)))
        if "gauge_gain" in parameters:
            found["gains"] = [(every.values[key], calibration.values[key]) for key in
                              ("gauge_1_gain_V_per_rad", "gauge_2_gain_V_per_rad")]
        if "gauge_offset" in parameters:
            found["offsets"] = moved
        if "object_origin" in parameters:
            found["irregular"].append((name + ", the other sense", Outline(
                tools, f"{folder}/all/other_sense", same, irregular, place, sense=-1)))
    found["repeat"] = [1e3 * abs(float(irregular[0][f"gauge_{j}_V"]) - float(irregular[-1][f"gauge_{j}_V"])) for j in (1, 2)]
    return found


def calibrated(tools):
    log = data.gauged()
    return tools.calibrate("all_rows", data.FOLDER / "steel_finger.yaml",
                           gauged_finger.plan(gauged_finger.PLAN, {}), {"r20": log})

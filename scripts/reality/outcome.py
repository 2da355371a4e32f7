#!/usr/bin/python3
"""Calibrates with one log, estimates the other and compares both with the truth.

outcome.py ESTIMATES.csv TRUTH.csv compares estimates that are there.
"""

import csv
import math
import pathlib
import shutil
import statistics
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("outcome.py", __name__)

import yaml


class Failed(Exception):
    """A command of finray failed; the message has its last line."""


def run(build, command, *arguments, allowed=(0,)):
    ended = subprocess.run([build / command, *map(str, arguments)], capture_output=True, text=True, check=False)
    if ended.returncode not in allowed:
        lines = (ended.stderr or ended.stdout).strip().splitlines() or ["no message"]
        raise Failed(f"{command} ends with {ended.returncode}: {lines[-1]}")
    return ended


def rows(path):
    with open(path, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def number(text):
    return float(text) if text else math.nan


def true_values(plant):
    """By the names of calibration.yaml; ribs are as drawn."""
    values = {f"{side}_stiffness_N_mm2": plant.stiffness(side) for side in ("front", "back")}
    if plant.ribs[0].thickness_mm:
        values["rib_bending_stiffness_N_mm2"] = plant.rib_section(plant.ribs[0])[1]
    for j, gauge in enumerate(plant.gauges, 1):
        values[f"gauge_{j}_gain_V_per_rad"] = gauge.gain_V_per_rad
        values[f"gauge_{j}_offset_V"] = gauge.offset_V
    return values


def parameters(calibration, plant):
    """Name, true value, value, std; of a rib the change of its length."""
    truth, found = true_values(plant), []
    for entry in calibration["parameters"]:
        name, value = entry["name"], entry["value"]
        if entry["status"] == "fixed":
            continue
        if name.startswith("rib_") and name.endswith("_length_mm"):
            found.append({"name": name.replace("length", "longer_by"), "true": 0.0,
                          "value": value - entry["initial"], "std": entry["std"]})
        else:
            found.append({"name": name, "true": truth.get(name), "value": value, "std": entry["std"]})
    return found


def scene_of(plan, calibration, scene, out):
    """The scene to estimate in: where the plan's friction follows the motion, as `scene`
    with the friction that the calibration found."""
    planned = yaml.safe_load(plan.read_text("utf-8"))["scene"]
    if not isinstance(planned, dict) or "presliding_mm" not in planned:
        return scene
    found = {entry["name"]: entry["value"] for entry in calibration["parameters"]}
    path = out / "scene.yaml"
    path.write_text(yaml.safe_dump({"schema_version": 1, **planned,
                                    "friction_coefficient": max(0.0, found["friction_coefficient"])}), "utf-8")
    return path


def errors(estimates, truth, knows_friction=False):
    """Of the frames with status ok: error and std of force and place; the error of the
    tangent angle in deg and that of force in percent."""
    found = {"force": [], "place": [], "angle": [], "percent": []}
    for row, true in zip(estimates, truth):
        if row["status"] != "ok" or not number(true["normal_1_N"]) > 0:
            continue
        # A second contact, where none is, belongs to the force.
        normal = number(row["normal_1_N"])
        if number(row.get("normal_2_N", "")) > 0:
            normal += number(row["normal_2_N"])
        # Without friction in the model, its force is the whole one, as the force sensor reads.
        friction = 0 if knows_friction else number(true.get("friction_1") or "0")
        force = number(true["normal_1_N"]) * math.hypot(1, friction)
        found["force"].append((normal - force, number(row["normal_1_std_N"])))
        found["place"].append((number(row["contact_1_mm"]) - number(true["contact_1_mm"]),
                               number(row["contact_1_std_mm"])))
        found["angle"].append(math.degrees(number(row["contact_1_angle_rad"]) - number(true["contact_1_angle_rad"])))
        found["percent"].append(100 * found["force"][-1][0] / force)
    return found


def means(found):
    """Mean sizes of the errors, as the paper gives them."""
    sizes = {"place_mm": [abs(e) for e, _ in found["place"]], "angle_deg": [abs(e) for e in found["angle"]],
             "force_N": [abs(e) for e, _ in found["force"]], "force_percent": [abs(e) for e in found["percent"]]}
    return {name: statistics.fmean(values) if values else math.nan for name, values in sizes.items()}


def summary(pairs):
    """rms and largest error, and the share within 1 and 1.96 std, in percent."""
    if not pairs:
        return {"rms": math.nan, "max": math.nan, "covered_68": math.nan, "covered_95": math.nan}
    size = [abs(error) for error, _ in pairs]

    def within(k):
        return 100 * sum(abs(error) < k * std for error, std in pairs) / len(pairs)
    return {"rms": math.sqrt(sum(e * e for e in size) / len(size)), "max": max(size),
            "covered_68": within(1.0), "covered_95": within(1.96)}


def outcome(build, finger, plan, logs, plant, scene, out):
    """logs: a folder with train.csv, holdout.csv and holdout_truth.csv. Of a log that is
    refused only the reason."""
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    # 2: the log is refused; 4: solved, but fails a gate.
    ended = run(build, "finray_calibrate", "--finger", finger, "--plan", plan, "--logs", logs / "train.csv",
                "--out_dir", out, allowed=(0, 2, 4))
    if ended.returncode == 2:
        return {"exit": 2, "refused": ended.stderr.strip().splitlines()[-1]}
    calibration = yaml.safe_load((out / "calibration.yaml").read_text("utf-8"))
    own_scene = scene_of(plan, calibration, scene, out)
    run(build, "finray_estimate", "--finger", out / "finger.yaml", "--scene", own_scene,
        "--logs", logs / "holdout.csv", "--out_dir", out)
    estimates, truth = rows(out / "holdout.frames.csv"), rows(logs / "holdout_truth.csv")
    compared = errors(estimates, truth, own_scene != scene)
    touched = [row for row, true in zip(estimates, truth) if number(true["normal_1_N"]) > 0]
    unexplained = yaml.safe_load((out / "summary.yaml").read_text("utf-8"))["all"]["unexplained_frames"]
    return {"exit": ended.returncode, "verdict": calibration["verdict"],
            "warnings": [warning["code"] for warning in calibration["warnings"]],
            "parameters": parameters(calibration, plant), "chi2_per_dof": {
                family: values["chi2_per_dof"] for family, values in calibration["noise"].items()},
            "rejected": len(calibration["rejected_frames"]), "fitted": calibration["fit"]["frames"],
            "touched": len(touched), "ok": len(compared["force"]), "unexplained": unexplained,
            "second": sum(number(row.get("normal_2_N", "")) > 0 for row in touched if row["status"] == "ok"),
            "errors": compared, "means": means(compared), "force": summary(compared["force"]), "place": summary(compared["place"])}


def main(estimates_path, truth_path):
    """Prints how often the force of estimates in a scene without friction holds as what it may be."""
    estimates, truth = rows(estimates_path), rows(truth_path)
    for name, normal in (("whole force", False), ("normal force", True)):
        force = errors(estimates, truth, normal)["force"]
        of = summary(force)
        print(f"{name:12} within 1 and 1.96 std in {of['covered_68']:.0f} and {of['covered_95']:.0f} % of {len(force)} frames, "
              f"{of['rms']:.3f} N rms")


if __name__ == "__main__":
    main(*guard.words(__doc__, 2, 2))

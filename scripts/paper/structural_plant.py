#!/usr/bin/python3
"""A finger that the model cannot be, in a lab that does not know it.

structural_plant.py BUILD_DIR OUT_DIR SEED

Draws a finger and a bench with errors of structure (`draw`), records a calibration log
on them, calibrates the drawn finger by it as a lab would (`finray_calibrate --explore`
with the bundled plan), and repeats three of the paper's experiments: contact frames and
forces on the 4 x 6 grid, outlines, and an object that comes and goes. Only the plant has
the errors. Writes OUT_DIR/results.yaml and the outlines' folders beside it.
"""

import math
import pathlib
import random
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("structural_plant.py", __name__)

import numpy as np
import yaml

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / "model_errors"), str(ROOT / "scripts" / "studies")]

import contact_cycles
import effects

DRAWN = ROOT / "configs" / "fingers" / "paper_140mm.yaml"
PLAN = ROOT / "configs" / "plans" / "force_and_circle.yaml"
PLACES = ROOT / "datasets" / "simulated_r15" / "train.csv"
RADIUS_MM, NOISE_RAD = 15, 3e-4
HEIGHTS_MM, FORCES_N = (30, 45, 60, 75, 90, 105), (1.5, 2.5, 3.5, 4.5)
REPEATS = 10  # of noise
STAGE_STD_MM = 0.02  # of the outlines' stage

# What is drawn beyond the parameters that the bundled plan frees.
MOST_FRICTION, MOST_HINGE_N_MM_PER_RAD = 0.2, 20
GAUGE_STD_MM, TURN_STD_DEG, TAPER_PERCENT = 0.5, 0.3, 5
WORDS = (f"friction 0 to {MOST_FRICTION:g}, hinges of 0 to {MOST_HINGE_N_MM_PER_RAD:g} N mm/rad, stiffness of either beam "
         f"tapering by {TAPER_PERCENT:g} %, gauges {GAUGE_STD_MM:g} mm (std) beside their drawing, stage turned by "
         f"{TURN_STD_DEG:g} deg (std), beside stiffness 15 %, ribs 0.2 mm, gains and offsets")


def taper(finger, numbers):
    """Twenty pieces; either end may be the stiffer one."""
    count = 20
    for beam, length in zip(("front", "back"), effects.lengths(finger)):
        share = numbers.choice((-1, 1)) * TAPER_PERCENT / 100
        stiffness = finger["beams"][beam].pop("bending_stiffness_N_mm2")
        pieces = [{"end_mm": length * k / count,
                   "bending_stiffness_N_mm2": stiffness * (1 + share * ((k - 0.5) / count - 0.5))}
                  for k in range(1, count + 1)]
        del pieces[-1]["end_mm"]
        finger["beams"][beam]["pieces"] = pieces


def draw(seed):
    """(finger, bench): dictionaries, the finger that of a YAML."""
    numbers = random.Random(seed)
    finger = effects.true_finger(yaml.safe_load(DRAWN.read_text("utf-8")), numbers)
    bench = {"friction": numbers.uniform(0, MOST_FRICTION), "turn_deg": numbers.gauss(0, TURN_STD_DEG),
             "hinge_N_mm_per_rad": numbers.uniform(0, MOST_HINGE_N_MM_PER_RAD)}
    taper(finger, numbers)
    for rib in finger["ribs"]:
        rib["hinge_stiffness_N_mm_per_rad"] = bench["hinge_N_mm_per_rad"]
    for gauge in finger["gauges"]:
        gauge["start_mm"] += numbers.gauss(0, GAUGE_STD_MM)
        gauge["noise_V"] = NOISE_RAD * gauge["gain_V_per_rad"]
    return finger, bench


def turned(x, y, angle_deg):
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return c * x - s * y, s * x + c * y


def moved(log, stage):
    """Places of the log in the axes of another stage: origin x, y (mm) and turn (deg)."""
    rows = contact_cycles.read(log)
    x, y = turned(*(contact_cycles.numbers(rows[f"object_{axis}_mm"]) for axis in "xy"), stage[2])
    rows["object_x_mm"], rows["object_y_mm"] = ([repr(float(value)) for value in values]
                                                for values in (x + stage[0], y + stage[1]))
    if "object_angle_deg" in rows:
        rows["object_angle_deg"] = [repr(float(angle) + stage[2]) for angle in rows["object_angle_deg"]]
    contact_cycles.write_rows(log, rows, zip(*rows.values()))


class Lab:
    """The plant, and what the lab knows of it after calibration."""

    def __init__(self, build, out, seed):
        self.build, self.out, self.seed = build, out, seed
        out.mkdir(parents=True, exist_ok=True)
        finger, self.bench = draw(seed)
        self.plant = self._write("plant.yaml", finger)
        self.world = self._write("world.yaml", {"object": {"shape": "circle", "radius_mm": RADIUS_MM},
                                                "friction_coefficient": self.bench["friction"]})
        drawn = yaml.safe_load(DRAWN.read_text("utf-8"))
        for gauge, true in zip(drawn["gauges"], finger["gauges"]):
            gauge["noise_V"] = true["noise_V"]  # as measured on the free finger
        self.drawn = self._write("drawn.yaml", drawn)

    def _write(self, name, content):
        path = self.out / name
        path.write_text(yaml.safe_dump({"schema_version": 1, **content} if "schema_version" not in content else content))
        return path

    def run(self, tool, *words, allowed=(0,), **flags):
        command = [self.build / tool, *words, *(f"--{name}={value}" for name, value in flags.items())]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode not in allowed:
            sys.exit(f"{tool}: {(done.stderr.strip().splitlines() or ['no message'])[-1]} (exit code {done.returncode})")

    def record(self, name, columns, seed, **more):
        """The truth of each row, and the log of it; the stage reads turned axes."""
        truth, log = self.out / f"{name}.truth.csv", self.out / f"{name}.csv"
        self.run("finray_simulate", finger=self.plant, scene=self.world,
                 frames=contact_cycles.write(self.out / f"{name}.in.csv", columns), out=truth, log_out=log, seed=seed,
                 strict="false", **more)
        self.turn(log)
        return contact_cycles.read(truth), log

    def turn(self, log):
        moved(log, (0, 0, -self.bench["turn_deg"]))

    def calibrate(self):
        """Leaves self.finger, self.friction and self.stage (x, y, deg), as calibrated."""
        places = contact_cycles.read(PLACES)
        _, log = self.record("calibration_log", {name: contact_cycles.numbers(places[name]) for name in
                                                 ("time_s", "object_x_mm", "object_y_mm")}, self.seed)
        folder = self.out / "calibration"
        self.run("finray_calibrate", "--explore", "--noreport", finger=self.drawn, plan=PLAN, logs=log, out_dir=folder,
                 allowed=(0, 4))
        found = yaml.safe_load((folder / "calibration.yaml").read_text("utf-8"))
        value = {one["name"]: one["value"] for one in found["parameters"]}
        self.finger = folder / "finger.yaml"
        self.friction = max(0, value.get("friction_coefficient", 0))
        self.stage = tuple(value.get(name, 0) for name in
                           ("object_origin_x_mm", "object_origin_y_mm", "object_rotation_deg"))
        plan = next(folder.glob("*plan*.yaml"), PLAN)
        known = yaml.safe_load(PLAN.read_text("utf-8"))["parameters"]
        return {"verdict": found["verdict"],
                "freed": sorted(set(yaml.safe_load(plan.read_text("utf-8"))["parameters"]) - set(known))}

    def known_scene(self, name, **more):
        return self._write(name, {"friction_coefficient": self.friction, **more})

    def depths(self, height):
        """Depth by force; the circle touches once on the way."""
        depth = np.concatenate([np.linspace(0, 0.2, 21), np.linspace(0.3, 12, 118)])
        truth, _ = self.record("sweep", {"object_x_mm": depth - RADIUS_MM, "object_y_mm": np.full_like(depth, height)}, 1)
        force = contact_cycles.numbers(truth["force_N"])
        known = np.isfinite(force)
        return lambda wanted: np.interp(wanted, force[known], depth[known])

    def contact_frames(self):
        places = [(self.depths(height)(force) - RADIUS_MM, height) for height in HEIGHTS_MM for force in FORCES_N]
        x, y = np.array(places * REPEATS).T
        truth, log = self.record("grid", {"object_x_mm": x, "object_y_mm": y}, self.seed + 100)
        estimates = self.out / "grid"
        self.run("finray_estimate", finger=self.finger, scene=self.known_scene("one.yaml", contacts=1), logs=log,
                 out_dir=estimates)
        rows = contact_cycles.read(log)
        origin_x, origin_y, turn = self.stage
        read_x, read_y = turned(*(contact_cycles.numbers(rows[f"object_{axis}_mm"]) for axis in "xy"), turn)
        self.run("finray_simulate", finger=self.finger,
                 scene=self.known_scene("stage.yaml", object={"shape": "circle", "radius_mm": RADIUS_MM}),
                 frames=contact_cycles.write(self.out / "stage.in.csv", {"object_x_mm": read_x + origin_x,
                                                                         "object_y_mm": read_y + origin_y}),
                 out=self.out / "stage.csv", strict="false")
        one = [not cell for cell in truth.get("normal_2_N", [""] * len(x))]
        result = {"frames": int(sum(one))}
        for way, path, friction in (("sensed", estimates / "grid.frames.csv", self.friction),
                                    ("kinetostatics", self.out / "stage.csv", self.friction)):
            result[way] = errors(truth, contact_cycles.read(path), friction, np.array(one))
        return result

    def outlines(self):
        folder = self.out / "outlines"
        self.run("tests/reconstruction_study", "write", folder, self.seed, self.plant, self.bench["friction"])
        scene, empty = self.known_scene("one.yaml", contacts=1), 0
        for log in sorted(folder.glob("*.touches.csv")):
            name = log.name[:-len(".touches.csv")]
            empty += without_empty_rows(log)
            self.turn(log)
            moved(log, self.stage)  # as the lab found it
            self.run("finray_reconstruct", finger=self.finger, scene=scene, logs=log, truth=folder / f"{name}.outline.csv",
                     stage_std_mm=STAGE_STD_MM, plots="false", out_dir=folder / "single" / name)
        return {"empty_touches": empty}

    def presses(self):
        """The worst of three heights at 30 frames a second: frames the estimator vouches
        for; all frames; all with what is known of the presses."""
        rows = []
        for height in contact_cycles.HEIGHTS_MM:
            time = np.arange(0, contact_cycles.DURATION_S, 1 / 30)
            wanted = contact_cycles.wanted_force(time)
            depth = np.where(wanted > 0, self.depths(height)(wanted), -2.0)
            truth, log = self.record(f"presses_{height}", {"time_s": time, "object_x_mm": depth - RADIUS_MM,
                                                           "object_y_mm": np.full_like(time, height)}, self.seed + 200)
            known = yaml.safe_load(contact_cycles.KNOWN)
            force = contact_cycles.numbers(truth["force_N"])
            row = {}
            for way, more in (("plain", {}), ("known", known)):
                folder = self.out / f"presses_{way}"
                self.run("finray_estimate", finger=self.finger, scene=self.known_scene(f"{way}.yaml", **more), logs=log,
                         out_dir=folder)
                found = contact_cycles.read(folder / f"{log.stem}.frames.csv")
                error = forces(found, self.friction) - force
                used = np.isin(found["status"], ["ok", "no_contact"])
                row[way] = {"rms_N": float(contact_cycles.rms(error[used])),
                            "max_N": float(np.max(np.abs(error[used]))),
                            "rms_of_all_N": float(contact_cycles.rms(error))}
            rows.append(row)
        return {way: {key: max(row[way][key] for row in rows) for key in rows[0][way]} for way in ("plain", "known")}


def without_empty_rows(log):
    """Takes the touches out that found no equilibrium. Returns their number."""
    rows = contact_cycles.read(log)
    kept = [cells for cells in zip(*rows.values()) if cells[list(rows).index("gauge_1_V")]]
    contact_cycles.write_rows(log, rows, kept)
    return len(rows["gauge_1_V"]) - len(kept)


def forces(rows, friction):
    """Of all contacts together, as a sensor under the object reads."""
    return math.hypot(1, friction) * sum(np.nan_to_num(contact_cycles.numbers(rows[name]))
                                         for name in ("normal_1_N", "normal_2_N") if name in rows)


def errors(truth, found, friction, counted):
    """Mean errors of place, angle and force over the frames of one contact, NaN if one
    has no estimate."""
    def column(rows, name):
        return contact_cycles.numbers(rows[name])[counted]
    off = [column(found, name) - column(truth, name) for name in
           ("contact_1_x_mm", "contact_1_y_mm", "contact_1_angle_rad")]
    force = forces(found, friction)[counted] - column(truth, "force_N")
    return {"place_mm": float(np.mean(np.hypot(off[0], off[1]))),
            "angle_deg": float(np.mean(np.abs(np.degrees(off[2])))), "force_N": float(np.mean(np.abs(force))),
            "force_percent": float(100 * np.mean(np.abs(force) / column(truth, "force_N")))}


def main():
    build, out, seed = guard.words(__doc__, 3, 3)
    lab = Lab(pathlib.Path(build).resolve(), pathlib.Path(out), int(seed))
    results = {"words": WORDS, "bench": lab.bench, "calibration": lab.calibrate(), "contact_frames": lab.contact_frames(),
               "presses": lab.presses(), "outlines": lab.outlines()}
    (lab.out / "results.yaml").write_text(yaml.safe_dump(results, sort_keys=False))


if __name__ == "__main__":
    main()

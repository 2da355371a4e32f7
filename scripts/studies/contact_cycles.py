#!/usr/bin/python3
"""Four cycles of contact and separation in 60 s, 0 to 8 N, by the command line.

contact_cycles.py BUILD_DIR OUT_DIR

Simulates a circle of R = 15 mm that is pressed in and drawn back (the paper's
Fig. 22: the same gaps of 0.26, 0.77 and 0.14 s), adds the noise of the gauges
(3e-4 rad), estimates with `contacts: auto`, and compares with the true force:
at 30 and 100 Hz, at three heights, with the true finger and with one that was
calibrated from a noisy log; for the latter also with smoothing and a limit of force.
Prints a table and writes it as contact_cycles.csv.
Draws contact_cycles.png and writes its points as contact_cycles_frames.csv.
"""

import csv
import math
import pathlib
import re
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("contact_cycles.py", __name__)

import numpy as np

from plot_style import BLUE, INK, ORANGE, plt, save

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATASET = ROOT / "datasets" / "simulated_r15"
RADIUS_MM = 15
NOISE_RAD = 3e-4
MOST_FORCE_N = 8
DURATION_S, REST_S, GAPS_S = 60.0, 1.0, (0.26, 0.77, 0.14)
HEIGHTS_MM, RATES_HZ = (45, 70, 95), (30, 100)
SHOWN = (70, 100, "calibrated")
COLUMNS = ("rate_Hz", "height_mm", "finger", "rms_N", "max_N", "rms_of_all_N", "unobservable", "frames",
           "unobservable_up_to_N", "contact_in_free_frames", "free_frames", "lightest_seen_N", "gauge_noise_rad")


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] for row in rows] for name in rows[0]}


def numbers(cells):
    return np.array([float(cell) if cell else math.nan for cell in cells])


def write_rows(path, names, rows):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows(rows)
    return path


def write(path, columns):
    return write_rows(path, columns, zip(*(column.tolist() for column in columns.values())))


# What a lab knows of the presses: no force beyond 10 N, and how much l_c and f_c change
# from frame to frame.
KNOWN = "force_max_N: 10\nsmoothing: {contact_std_mm: 0.2, normal_std_N: 0.1}\n"


class Tools:
    """Runs the tools with the true finger and with one that was calibrated anew."""

    def __init__(self, build, out):
        self.build, self.out = build, out
        out.mkdir(parents=True, exist_ok=True)
        self.scene = out / "circle.yaml"
        self.scene.write_text(f"object: {{shape: circle, radius_mm: {RADIUS_MM}}}\n")
        self.finger = out / "true_finger.yaml"
        self.with_noise(DATASET / "hidden_finger.yaml", self.finger)

    def run(self, tool, **flags):
        words = [word for name, value in flags.items() for word in (f"--{name}", str(value))]
        subprocess.run([self.build / tool, *words], check=True, stdout=subprocess.DEVNULL)

    def with_noise(self, finger, to):
        """Gauge noise of NOISE_RAD through the true gains."""
        gains = iter(re.findall(r"gain_V_per_rad: *([\d.]+)", (DATASET / "hidden_finger.yaml").read_text()))
        to.write_text(re.sub(r"noise_V: *[\d.e-]+", lambda _: f"noise_V: {NOISE_RAD * float(next(gains)):g}",
                             finger.read_text()))

    def simulate(self, name, columns, seed):
        """The truth of every frame, and the path of the log with noise."""
        truth, log = self.out / f"{name}.truth.csv", self.out / f"{name}.csv"
        # The log keeps the true force, so that the reference has no noise.
        self.run("finray_simulate", finger=self.finger, scene=self.scene,
                 frames=write(self.out / f"{name}.frames.in.csv", columns), out=truth, log_out=log, seed=seed,
                 force_std_N=0)
        return read(truth), log

    def calibrate(self):
        places = read(DATASET / "train.csv")
        columns = {name: numbers(places[name]) for name in ("time_s", "object_x_mm", "object_y_mm")}
        start, log = self.out / "nominal_finger.yaml", self.out / "calibration_log.csv"
        self.with_noise(ROOT / "configs" / "fingers" / "paper_140mm.yaml", start)
        self.run("finray_simulate", finger=self.finger, scene=self.scene,
                 frames=write(self.out / "calibration.in.csv", columns), out=self.out / "calibration.truth.csv",
                 log_out=log, seed=11)
        plan = ROOT / "configs" / "plans" / "force_and_circle.yaml"
        self.run("finray_calibrate", finger=start, plan=plan, logs=log, out_dir=self.out / "calibration")
        return self.out / "calibration" / "finger.yaml"

    def estimate(self, finger, known, log, folder):
        scene = self.out / f"{folder}.yaml"
        scene.write_text(f"schema_version: 1\n{known}")
        self.run("finray_estimate", finger=finger, scene=scene, logs=log, out_dir=self.out / folder, threads=2)
        return read(self.out / folder / f"{log.stem}.frames.csv")


def rms(error):
    return np.sqrt(np.mean(error ** 2))


def wanted_force(time):
    """Four presses of equal length between the gaps."""
    length = (DURATION_S - 2 * REST_S - sum(GAPS_S)) / 4
    force = np.zeros_like(time)
    start = REST_S
    for gap in (*GAPS_S, REST_S):
        share = (time - start) / length
        pressed = (share > 0) & (share < 1)
        force[pressed] = MOST_FORCE_N * np.sin(math.pi * share[pressed]) ** 2
        start += length + gap
    return force


def depth_of_force(tools, height):
    depths = np.concatenate([np.linspace(0, 0.2, 41), np.linspace(0.25, 12, 236)])
    sweep, _ = tools.simulate("sweep", {"object_x_mm": depths - RADIUS_MM, "object_y_mm": np.full_like(depths, height)}, 1)
    forces = numbers(sweep["force_N"])
    known = np.isfinite(forces)
    return lambda force: np.where(force > 0, np.interp(force, forces[known], depths[known]), -2.0)


def cycle(tools, fingers, height, rate, seed):
    """Rows of results, one for each finger; and the frames for the plot."""
    time = np.arange(0, DURATION_S, 1 / rate)
    depth = depth_of_force(tools, height)(wanted_force(time))
    name = f"cycles_{height}mm_{rate}Hz"
    truth, log = tools.simulate(name, {"time_s": time, "object_x_mm": depth - RADIUS_MM,
                                       "object_y_mm": np.full_like(time, height)}, seed)
    force = numbers(truth["force_N"])
    rows, frames = [], {}
    for label, (finger, known) in fingers.items():
        result = tools.estimate(finger, known, log, label)
        estimate, std = numbers(result["normal_1_N"]), numbers(result["normal_1_std_N"])
        status = np.array(result["status"])
        if "normal_2_N" in result:  # against the sum of both, as a sensor under the object reads
            estimate = estimate + np.nan_to_num(numbers(result["normal_2_N"]))
        error, free = estimate - force, force < 1e-12
        used = np.isin(status, ["ok", "no_contact"])
        rows.append((rate, height, label, rms(error[used]), np.max(np.abs(error[used])), rms(error), int(np.sum(~used)),
                     len(time), np.max(force[~used], initial=0), int(np.sum(free & (status != "no_contact"))),
                     int(np.sum(free)), np.max(force[status == "no_contact"])))
        frames[label] = (time, force, np.where(used, estimate, np.nan), np.where(status == "ok", std, np.nan))
    return rows, frames


def plot(frames, path):
    time, force, estimate, std = frames
    error = estimate - force
    zoom = (28.6, 31.8)  # about the second gap
    figure, axes = plt.subplots(2, 2, figsize=(9.5, 5), sharex="col", width_ratios=(2.4, 1), height_ratios=(1.5, 1))
    for line, span in zip(axes.T, ((0, DURATION_S), zoom)):
        top, bottom = line
        close = span is zoom
        top.plot(time, force, color=INK, linewidth=2.6, label="true force")
        top.plot(time, estimate, color=ORANGE, linewidth=1.2, marker="o" if close else "", markersize=2.2,
                 linestyle="" if close else "-", label="from four gauges")
        bottom.plot(time, error, color=ORANGE, linewidth=0.5, marker="o" if close else "", markersize=2.2,
                    linestyle="" if close else "-", label="error")
        for sign in (-2, 2):
            bottom.plot(time, sign * std, color=BLUE, linewidth=1.1, label="±2 std of each frame" if sign > 0 else None)
        bottom.set_ylim(-0.1, 0.1)
        bottom.set_xlim(*span)
        bottom.set_xlabel("time, s")
    axes[0, 0].set_ylim(-0.3, 8.6)
    axes[0, 1].set_ylim(-0.06, 1.05)
    axes[0, 0].set_ylabel("force, N")
    axes[1, 0].set_ylabel("error, N")
    axes[0, 0].set_title("Four contacts in a minute, 100 frames a second")
    axes[0, 1].set_title("The second gap, 0.77 s")
    handles = [handle for axis in axes[:, 0] for handle in axis.get_legend_handles_labels()[0]]
    figure.tight_layout()
    figure.align_ylabels()
    figure.legend(handles, [handle.get_label() for handle in handles], loc="lower center", ncol=4,
                  bbox_to_anchor=(0.5, -0.06))
    save(figure, path)


def main():
    build, out = map(pathlib.Path, guard.words(__doc__, 2, 2))
    tools = Tools(build, out / "cycles")
    calibrated = tools.calibrate()
    fingers = {"true": (tools.finger, ""), "calibrated": (calibrated, ""), "smoothed": (calibrated, KNOWN)}
    print("| frames/s | height, mm | finger | rms error, N | largest, N | rms with unobservable, N | unobservable "
          "| up to, N | contact in free frames | lightest seen, N |\n|---|---|---|---|---|---|---|---|---|---|\n"
          "| 30 | | the paper, measured | 0.18 | 0.61 | | | | | |")
    table = []
    for seed, (rate, height) in enumerate(((r, h) for r in RATES_HZ for h in HEIGHTS_MM), start=1):
        rows, frames = cycle(tools, fingers, height, rate, seed)
        table += rows
        for row in rows:
            print("| %d | %d | %s | %.4f | %.3f | %.3f | %d of %d | %.2f | %d of %d | %.3f |" % row, flush=True)
        if (height, rate) == SHOWN[:2]:
            plot(frames[SHOWN[2]], out / "contact_cycles.png")
            names = ("time_s", "force_N", "force_estimate_N", "force_estimate_std_N")
            write(out / "contact_cycles_frames.csv", dict(zip(names, frames[SHOWN[2]])))
    write_rows(out / "contact_cycles.csv", COLUMNS, [(*row, NOISE_RAD) for row in table])


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Measures time and error of a calibration: frames, scheme, tolerance, threads.

calibration_speed.py BUILD_DIR OUT.json [FRAMES ...]

Simulates logs of the bundled hidden finger (by default 210, 1000 and 10 000
frames; a million take some minutes to simulate) and calibrates the 15
parameters of configs/plans/force_and_circle.yaml. For each setting it prints
seconds of the CPU and by the clock, of the whole command without its HTML page
(five starts and outliers included, the least of three runs each, as other work
only lengthens them), the peak memory, and the error: how far the
worst parameter is from its value under a tolerance of 1e-6 std, in the std that
the noise of the log leaves it. OUT.json is for the page of
finray_benchmark. Where BUILD_DIR/tests has calibration_forms_study, the reduced and the
weighted form of equilibrium follow, 15 to 60 frames in one Ceres problem each.
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("calibration_speed.py", __name__)

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from make_dataset import RADIUS_MM, places

ROOT = pathlib.Path(__file__).resolve().parents[2]
HIDDEN = ROOT / "datasets" / "simulated_r15" / "hidden_finger.yaml"
PLAN = ROOT / "configs" / "plans" / "force_and_circle.yaml"
START = ROOT / "configs" / "fingers" / "paper_140mm.yaml"
REPEATS = 3
MOST_FRAMES_OF_LINKS = 300  # more take minutes
# Name, what the plots tell apart, flags. The first is the default.
SETTINGS = (
    ("default", "default", ()),
    ("2 threads", "threads", ("--threads", "2")),
    ("tolerance 10 std", "tolerance", ("--tolerance_std", "10")),
    ("tolerance 1 std", "tolerance", ("--tolerance_std", "1")),
    ("tolerance 0.1 std", "tolerance", ("--tolerance_std", "0.1")),
    ("tolerance 1e-4 std", "tolerance", ("--tolerance_std", "1e-4")),
    ("order 4, one element a bay", "scheme", ("--scheme", "taylor4", "--resolution", "12")),
    ("order 8, one element a bay", "scheme", ("--scheme", "taylor8", "--resolution", "12")),
    ("order 12, one element a bay", "scheme", ("--scheme", "taylor12", "--resolution", "12")),
    ("100 rigid links", "scheme", ("--scheme", "rigid_chain", "--resolution", "100")),
)
REFERENCE = ("--tolerance_std", "1e-6")


def simulate(build, folder, frames):
    free = max(1, frames // 21)
    table = folder / "frames.csv"
    with open(table, "w") as file:
        file.write("time_s,object_x_mm,object_y_mm\n")
        for t, x, y in places(frames - free, free, 7):
            file.write(f"{t:.1f},{x:.6f},{y:.6f}\n")
    scene = folder / "scene.yaml"
    scene.write_text(f"contacts: auto\nobject: {{shape: circle, radius_mm: {RADIUS_MM}}}\n")
    log = folder / "log.csv"
    subprocess.run([build / "finray_simulate", "--finger", HIDDEN, "--scene", scene,
                    "--frames", table, "--out", folder / "all.csv", "--log_out", log],
                   check=True, stdout=subprocess.DEVNULL)
    return log


def calibrate(build, folder, log, flags):
    """Seconds of the command by CPU and clock, megabytes, and the parameters: name to value and
    std."""
    threads = () if "--threads" in flags else ("--threads", "1")
    start = time.perf_counter()
    process = subprocess.Popen([build / "finray_calibrate", "--finger", START, "--plan", PLAN,
                                "--logs", log, "--out_dir", folder / "out", "--noreport",
                                *threads, *flags],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    text = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    # Code 4 says that the logs show an effect beyond the plan, as with many frames they may.
    if os.waitstatus_to_exitcode(status) not in (0, 4):
        sys.exit(f"{' '.join(flags)}: {text}")
    result = yaml.safe_load((folder / "out" / "calibration.yaml").read_text())
    return usage.ru_utime + usage.ru_stime, seconds, usage.ru_maxrss / 1000, {
        p["name"]: (p["value"], p["std"]) for p in result["parameters"] if p["status"] != "fixed"}


def distance_std(found, reference):
    """The largest difference of a parameter in its std."""
    return max(abs(found[name][0] - value) / std for name, (value, std) in reference.items())


def forms(build):
    """The rows of calibration_forms_study, if it is built."""
    study = build / "tests" / "calibration_forms_study"
    if not study.exists():
        print(f"{study} is not built: the two forms of equilibrium are not compared")
        return []
    done = subprocess.run([study], check=True, stdout=subprocess.PIPE, text=True)
    rows = [{"frames": int(row["frames"]), "setting": row["form"], "kind": "form", "cpu_s": float(row["cpu_s"]),
             "iterations": int(row["iterations"]), "converged": row["converged"], "error_std": float(row["error_std"])}
            for row in csv.DictReader(done.stdout.splitlines())]
    for row in rows:
        print(f"{row['frames']:7} {row['setting'] + ' form':28} {row['cpu_s']:7.3f} {'':8} {row['error_std']:10.1e}")
    return rows


def main():
    build, out, *counts = guard.words(__doc__, 2)
    build, out = pathlib.Path(build).resolve(), pathlib.Path(out)
    rows = []
    print(f"{'frames':>7} {'setting':28} {'CPU, s':>7} {'clock, s':>8} {'error, std':>10} {'stiffness std, %':>16} {'MB':>5}")
    for frames in [int(a) for a in counts] or [210, 1000, 10000]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            log = simulate(build, folder, frames)
            *_, reference = calibrate(build, folder, log, REFERENCE)
            value, std = reference["front_stiffness_N_mm2"]
            for setting, kind, flags in SETTINGS:
                if "rigid_chain" in flags and frames > MOST_FRAMES_OF_LINKS:
                    continue
                runs = [calibrate(build, folder, log, flags)
                        for _ in range(REPEATS if frames <= 10000 else 1)]
                cpu, seconds, memory = (min(run[k] for run in runs) for k in range(3))
                found = runs[0][3]  # all runs find the same
                rows.append({"frames": frames, "setting": setting, "kind": kind,
                             "cpu_s": cpu, "clock_s": seconds, "error_std": distance_std(found, reference),
                             "stiffness_std_percent": 100 * std / value, "memory_MB": memory})
                print(f"{frames:7} {setting:28} {cpu:7.2f} {seconds:8.2f} {rows[-1]['error_std']:10.1e}"
                      f" {100 * std / value:16.2f} {memory:5.0f}", flush=True)
    rows += forms(build)
    partial = out.with_name(out.name + ".part")
    partial.write_text(json.dumps(rows, indent=1) + "\n")
    partial.rename(out)


if __name__ == "__main__":
    main()

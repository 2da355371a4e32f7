#!/usr/bin/python3
"""Measures how long a calibration takes, by the number of frames.

calibration_speed.py BUILD_DIR [FRAMES ...]

Simulates logs of the bundled hidden finger (by default 1000, 10 000 and 100 000
frames; a million take some minutes to simulate), calibrates the 15 parameters
of configs/plans/force_and_circle.yaml with one and two threads, and prints
seconds of the solve (five starts and outliers included), of the whole command
without its HTML page, and the peak memory.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from make_dataset import RADIUS_MM, places

ROOT = pathlib.Path(__file__).resolve().parents[2]
HIDDEN = ROOT / "datasets" / "simulated_r15" / "hidden_finger.yaml"
PLAN = ROOT / "configs" / "plans" / "force_and_circle.yaml"
START = ROOT / "configs" / "fingers" / "paper_140mm.yaml"
REPEATS = 3


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


def calibrate(build, folder, log, threads):
    """Seconds of the solve and of the whole command, and megabytes."""
    start = time.perf_counter()
    process = subprocess.Popen([build / "finray_calibrate", "--finger", START, "--plan", PLAN,
                                "--logs", log, "--out_dir", folder / "out", "--noreport",
                                "--threads", str(threads), "--v", "1"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    text = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    if status != 0:
        sys.exit(text)
    solve = float(re.search(r"\] solve: ([\d.e+-]+) s", text).group(1))
    return solve, seconds, usage.ru_maxrss / 1000


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__.strip())
    build = pathlib.Path(sys.argv[1]).resolve()
    print(f"{'frames':>8} {'threads':>7} {'solve, s':>9} {'all, s':>8} {'us/frame':>9} {'MB':>6}")
    for frames in [int(a) for a in sys.argv[2:]] or [1000, 10000, 100000]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            log = simulate(build, folder, frames)
            for threads in (1, 2):
                runs = [calibrate(build, folder, log, threads)
                        for _ in range(REPEATS if frames <= 100000 else 1)]
                solve, seconds, memory = sorted(runs)[len(runs) // 2]
                print(f"{frames:8} {threads:7} {solve:9.2f} {seconds:8.2f}"
                      f" {1e6 * seconds / frames:9.1f} {memory:6.0f}", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Compares the time of calibrations by two builds, in turn on the same logs.

compare_calibration_speed.py BUILD_DIR OTHER_BUILD_DIR [FRAMES ...]

Simulates a log as calibration_speed.py does (by default of 10 000 frames) and
calibrates it with both builds in turn, five times each, once beyond 10 000
frames, with one thread and with two. For each it prints the medians of the
seconds of the CPU and by the clock of the whole command without its page, how
many times as long OTHER_BUILD_DIR takes, and the largest difference of a
parameter in its std.
"""

import pathlib
import statistics
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("compare_calibration_speed.py", __name__)

from calibration_speed import calibrate, distance_std, simulate

REPEATS = 5
MOST_FRAMES_TO_REPEAT = 10000


def main():
    given = guard.words(__doc__, 2)
    builds = [pathlib.Path(argument).resolve() for argument in given[:2]]
    print(f"{'frames':>8} {'threads':>7} {'CPU, s':>15} {'ratio':>6} {'clock, s':>15} {'ratio':>6} {'apart, std':>10}")
    for frames in [int(a) for a in given[2:]] or [10000]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            log = simulate(builds[0], folder, frames)
            for threads in (1, 2):
                runs = [[], []]
                for _ in range(REPEATS if frames <= MOST_FRAMES_TO_REPEAT else 1):
                    for build, own in zip(builds, runs):
                        own.append(calibrate(build, folder, log, ("--threads", str(threads))))
                (cpu, other_cpu), (clock, other_clock) = (
                    [statistics.median(run[k] for run in own) for own in runs] for k in (0, 1))
                apart = distance_std(runs[0][0][3], runs[1][0][3])
                print(f"{frames:8} {threads:7} {cpu:7.2f} {other_cpu:7.2f} {other_cpu / cpu:6.2f}"
                      f" {clock:7.2f} {other_clock:7.2f} {other_clock / clock:6.2f} {apart:10.1e}", flush=True)


if __name__ == "__main__":
    main()

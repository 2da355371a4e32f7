#!/usr/bin/python3
"""Compares two results of finray_estimate on one log, frame by frame.

compare_frames.py A.frames.csv B.frames.csv

Prints the sums of `iterations`, how many frames change from one status to
another, the largest differences of place and force of frames that are `ok` in
both, in the std of A, and how many of these frames are more than 1e-5 std apart.
"""

import collections
import csv
import itertools
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("compare_frames.py", __name__)


def frames(path):
    with open(path, encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


FAR_STD = 1e-5


def main():
    compared = guard.words(__doc__, 2, 2)
    iterations, changes = [0, 0], collections.Counter()
    ok = far = 0
    largest = {"contact_1_mm": 0.0, "normal_1_N": 0.0}
    for both in itertools.zip_longest(*map(frames, compared)):
        if None in both:
            sys.exit("the results have different numbers of frames")
        a, b = both
        for k, frame in enumerate(both):
            iterations[k] += int(frame["iterations"] or 0)
        if a["status"] != b["status"]:
            changes[a["status"], b["status"]] += 1
        elif a["status"] == "ok":
            most = 0.0
            for name in largest:
                value, unit = name.rsplit("_", 1)
                off = abs(float(a[name]) - float(b[name])) / float(a[f"{value}_std_{unit}"])
                largest[name] = max(largest[name], off)
                most = max(most, off)
            ok += 1
            far += most > FAR_STD
    print("iterations", *iterations)
    for (before, after), count in changes.most_common():
        print(f"{count} frames from {before} to {after}")
    for name, off in largest.items():
        print(f"{name}: {off:.1e} std apart at most")
    print(f"{far} of {ok} ok frames more than {FAR_STD:g} std apart")


if __name__ == "__main__":
    main()

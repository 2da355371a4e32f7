#!/usr/bin/python3
"""Compares two results of finray_estimate on one log, frame by frame.

compare_frames.py A.frames.csv B.frames.csv

Prints the sums of `iterations`, how many frames change from one status to
another, the largest differences of place and force of frames that are `ok` in
both, in the std of A, and how many of these are more than 1e-5 std apart. For
frames that change or are apart it counts whose chi2 is lower by more than a
millionth: that result has the better contact.
"""

import collections
import csv
import itertools
import sys


def frames(path):
    with open(path, encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


# The load surface is exact to 1e-6 std, so smaller differences of chi2 say nothing.
FAR_STD, SAME = 1e-5, 1e-6


def better(a, b):
    """Whose contact explains the frame better."""
    one, other = (float(frame["chi2"] or "nan") for frame in (a, b))
    if not abs(one - other) > SAME * (1 + abs(one)):
        return "neither"
    return "A" if one < other else "B"


def lower_chi2(counts):
    return ", ".join(f"{name} {counts[name]}" for name in ("A", "B", "neither") if counts[name])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    iterations, ok = [0, 0], 0
    changes, apart = collections.defaultdict(collections.Counter), collections.Counter()
    largest = {"contact_1_mm": 0.0, "normal_1_N": 0.0}
    for both in itertools.zip_longest(*map(frames, sys.argv[1:])):
        if None in both:
            sys.exit("the results have different numbers of frames")
        a, b = both
        for k, frame in enumerate(both):
            iterations[k] += int(frame["iterations"] or 0)
        if a["status"] != b["status"]:
            changes[a["status"], b["status"]][better(a, b)] += 1
        elif a["status"] == "ok":
            ok += 1
            most = 0.0
            for name in largest:
                value, unit = name.rsplit("_", 1)
                off = abs(float(a[name]) - float(b[name])) / float(a[f"{value}_std_{unit}"])
                largest[name] = max(largest[name], off)
                most = max(most, off)
            if most > FAR_STD:
                apart[better(a, b)] += 1
    print("iterations", *iterations)
    for (before, after), counts in sorted(changes.items(), key=lambda change: -sum(change[1].values())):
        print(f"{sum(counts.values())} frames from {before} to {after}; chi2 lower in: {lower_chi2(counts)}")
    for name, off in largest.items():
        print(f"{name}: {off:.1e} std apart at most")
    far = sum(apart.values())
    print(f"{far} of {ok} ok frames more than {FAR_STD:g} std apart" +
          (f"; chi2 lower in: {lower_chi2(apart)}" if far else ""))


if __name__ == "__main__":
    main()

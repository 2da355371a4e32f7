#!/usr/bin/env python3
"""Estimates the contact in every frame of a log, and draws the forces.

usage: estimate.py FINGER.yaml LOG.csv
"""

import sys

import matplotlib

matplotlib.use("Agg")

import finray

finger, log = finray.Finger.read(sys.argv[1]), sys.argv[2]
found = finray.estimate(finger, log)
print(found.summary)
ok = found.status == "ok"
print(f"mean force of {ok.sum()} frames: {found['normal_1_N'][ok].mean():.3f} N")
finray.plot_estimates(found).figure.savefig("forces.png", dpi=150)

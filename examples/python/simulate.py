#!/usr/bin/env python3
"""Draws a finger under a contact and prints what its gauges read."""

import sys

import matplotlib

matplotlib.use("Agg")

import finray

finger = finray.Finger.read(sys.argv[1]) if len(sys.argv) > 1 else finray.paper_finger()
found = finray.simulate(finger, {"contact_1_mm": [40.0, 70.0, 100.0], "normal_1_N": [2.0, 2.0, 2.0]})
for row in range(3):
    volts = [found[f"gauge_{j}_V"][row] for j in range(1, finger.gauges + 1)]
    print(f"{found['contact_1_mm'][row]:5.0f} mm:", "  ".join(f"{value:8.5f} V" for value in volts))
finray.plot_finger(finger, 70.0, 2.0).figure.savefig("finger.png", dpi=150)

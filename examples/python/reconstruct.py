#!/usr/bin/env python3
"""Reconstructs the outline of an object from touches, and draws it.

usage: reconstruct.py FINGER.yaml TOUCHES.csv
"""

import sys

import matplotlib

matplotlib.use("Agg")

import finray

found = finray.reconstruct(finray.Finger.read(sys.argv[1]), sys.argv[2])
print(f"{found.usable_touches} of {found.rows} touches, {found.perimeter_mm:.1f} mm around, "
      f"{100 * found.supported_share:.0f} % supported")
finray.plot_outline(found).figure.savefig("outline.png", dpi=150)

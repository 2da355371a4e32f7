#!/usr/bin/env python3
"""From import to a calibrated finger of one's own.

usage: calibrate.py OUT_DIR LOG.csv...
"""

import sys

import finray

nominal = finray.Finger(
    name="mine",
    geometry={"front_length_mm": 140, "back_angle_deg": 112},
    beams={beam: {"bending_stiffness_N_mm2": 12500} for beam in ("front", "back")},
    ribs=[{"front_mm": 17 + 22 * i, "angle_deg": 10 + 3 * i} for i in range(5)],
    gauges=[{"beam": "back", "start_mm": start, "length_mm": 18, "noise_V": 3e-4} for start in (30, 53, 76, 98)])
plan = finray.Plan(
    scene={"contacts": "auto", "object": {"shape": "circle", "radius_mm": 15}},
    parameters={"front_stiffness": {"prior_std_percent": 50}, "back_stiffness": {"prior_std_percent": 50},
                "gauge_gain": {}, "gauge_offset": {}, "rib_length": {"prior_std_mm": 0.5},
                "object_origin": {"prior_std_mm": 0.5}},
    measurements={"force_std_N": 0.02, "object_std_mm": 0.05}, robust_loss={"type": "huber", "scale": 3.0})
found = finray.calibrate(nominal, plan, sys.argv[2:])
for parameter in found.parameters:
    print(f"{parameter.name:28} {parameter.value:12.6g} +- {parameter.std:.2g} {parameter.status}")
print("verdict:", found.verdict, *found.doubts)
found.write(sys.argv[1], report=False)

#!/usr/bin/python3
"""Contacts as wide as real objects press, estimated as the points that finray models.

PYTHONPATH=build/release/python scripts/reality/wide_contact.py

Plant and estimate are finray's: five equal forces side by side against one. Prints how often the 68 and 95 % intervals hold.
"""
import pathlib
import sys
import warnings

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("wide_contact.py", __name__)
guard.words(__doc__, 0, 0)

import numpy as np

import finray

FRAMES, NOISE_V, FORCES = 1000, 3e-4, 5

warnings.simplefilter("ignore", finray.FinrayWarning)  # the finger is not calibrated: it is exact
finger = finray.paper_finger()
random = np.random.default_rng(1)
place, force = random.uniform(35, 105, FRAMES), random.uniform(1, 6, FRAMES)
for width_mm in (0, 5, 10):
    load = {}
    for c, share in enumerate(np.linspace(-0.5, 0.5, FORCES), 1):
        load[f"contact_{c}_mm"], load[f"normal_{c}_N"] = place + share * width_mm, force / FORCES
    seen = finray.simulate(finger, load)
    found = finray.estimate(finger, {f"gauge_{j}_V": seen[f"gauge_{j}_V"] + random.normal(0, NOISE_V, FRAMES)
                                     for j in range(1, finger.gauges + 1)})
    ok = found.status == "ok"
    words = [f"{width_mm:2} mm wide: {ok.sum()} of {FRAMES} ok"]
    for name, error, std in (("force", found["normal_1_N"] - force, found["normal_1_std_N"]),
                             ("place", found["contact_1_mm"] - place, found["contact_1_std_mm"])):
        z = np.abs(error / std)[ok]
        words.append(f"{name} within 1 and 1.96 std in {100 * np.mean(z < 1):.0f} and {100 * np.mean(z < 1.96):.0f} %")
    print(", ".join([*words, f"{found.summary['unexplained']} unexplained"]))

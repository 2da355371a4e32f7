"""The second column: a plant with errors of structure, calibrated as a lab would."""

import statistics

from comparison import Section, count, worst
from inputs import folders, read_yaml

STUDY = "scripts/paper/structural_plant.py"
KEYS = ("words", "bench", "calibration", "contact_frames", "presses", "outlines")


def draws(folder):
    return [(seed, read_yaml(seed / "results.yaml", KEYS, STUDY))
            for seed in folders(folder / "structural", "seed_*", STUDY)]


def mean(folder, way, key):
    """Of the contact frames over the draws."""
    return statistics.fmean(result["contact_frames"][way][key] for _, result in draws(folder))


def worst_press(folder, way, key):
    return worst(result["presses"][way][key] for _, result in draws(folder))


def worst_outline(folder, stems, key):
    """The radial error of the worst of these objects and draws, percent."""
    return worst(read_yaml(seed / "outlines" / "single" / stem / "reconstruction.yaml", ("radial_error_percent",),
                           STUDY)["radial_error_percent"][key]
                 for seed, _ in draws(folder) for stem in stems)


def sections(folder):
    table = []
    for k, (_, result) in enumerate(draws(folder), 1):
        bench, found, sensed = result["bench"], result["calibration"], result["contact_frames"]["sensed"]
        table.append([k, f"{bench['friction']:.2f}", f"{bench['hinge_N_mm_per_rad']:.0f}", f"{bench['turn_deg']:+.2f}",
                      ", ".join(found["freed"]).replace("_", " ") or "nothing", found["verdict"],
                      f"{sensed['place_mm']:.2f}", f"{sensed['force_N']:.3f}", f"{result['presses']['plain']['rms_N']:.3f}"])
    words = draws(folder)[0][1]["words"]
    empty = sum(result["outlines"]["empty_touches"] for _, result in draws(folder))
    return [Section(
        "A plant with structural errors",
        f"The second column is of plants that the bundled plan does not describe, {count(len(table), 'draw')}: {words}. "
        "Only the plant has them. A log of 200 contacts and 10 free frames is recorded on each (force sensor 0.02 N, stage "
        "0.05 mm), the drawn finger is calibrated by it with finray_calibrate --explore, and the experiments are "
        "repeated with what it found. Springs, objects and force control are not repeated."
        + (f" {count(empty, 'touch')} of the outlines found no equilibrium under friction and is left out."
           if empty == 1 else f" {empty} touches of the outlines found no equilibrium under friction and are left out."
           if empty else ""),
        [], [],
        [("The draws", ("draw", "friction", "hinges, N mm/rad", "stage, deg", "freed by --explore", "verdict",
                        "place, mm", "force, N", "presses, N rms"), table,
          "Gauge places and taper are drawn too. Contact finite in length, hysteresis and ribs that bend are in no draw; "
          "fingers of another physics have them.")])]

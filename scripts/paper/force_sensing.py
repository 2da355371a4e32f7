"""Fig. 22: four contacts in a row, sensing only."""

import math

from comparison import Comparison, Section, worst
from inputs import read_csv
import structural
from look import AFTER, INK, legend, plt, svg

STUDY = "scripts/studies/contact_cycles.py"
COLUMNS = ("rate_Hz", "height_mm", "finger", "rms_N", "max_N", "rms_of_all_N", "unobservable", "frames",
           "unobservable_up_to_N", "gauge_noise_rad")


def plot(frames):
    time, force, estimate = ([row[name] for row in frames]
                             for name in ("time_s", "force_N", "force_estimate_N"))
    figure, (above, below) = plt.subplots(2, 1, figsize=(9.4, 4.2), sharex=True, height_ratios=(2, 1))
    above.plot(time, force, color=INK, lw=2.2, alpha=0.5, label="true force")
    above.plot(time, estimate, color=AFTER, lw=1, label="from four gauges")
    below.plot(time, [e - f for e, f in zip(estimate, force)], color=AFTER, lw=0.6)
    above.set(ylabel="force (N)")
    below.set(xlabel="time (s)", ylabel="error (N)", xlim=(0, time[-1]))
    legend(above, 2)
    return svg(figure, "Sensed force over four contacts")


def sections(parent):
    folder = parent / "force_sensing"
    cycles = read_csv(folder / "contact_cycles.csv", COLUMNS, STUDY)
    frames = read_csv(folder / "contact_cycles_frames.csv", ("time_s", "force_N", "force_estimate_N"), STUDY)
    used = [row for row in cycles if row["finger"] == "calibrated" and row["rate_Hz"] == 30]
    largest = {name: worst(used, key=lambda row: row[name]) for name in ("rms_N", "max_N", "rms_of_all_N")}
    height = {name: f"{row['height_mm']:g} mm" for name, row in largest.items()}
    share = 100 * worst(row["unobservable"] / row["frames"] for row in used)
    # Empty where no frame is flagged.
    flagged = [row["unobservable_up_to_N"] for row in used if not math.isnan(row["unobservable_up_to_N"])]
    touches = f", touches up to {max(flagged):.1f} N" if flagged else ""
    conditions = (f"gauge noise {used[0]['gauge_noise_rad']:g} rad, finger calibrated from a noisy log, 30 frames/s, "
                  "worst of heights "
                  + ", ".join(f"{row['height_mm']:g}" for row in used) + " mm")
    sure = f"frames the estimator vouches for ({share:.0f} % at most are flagged{touches})"
    rows = [
        Comparison("sensed force, object pressed in four times, rms", "Fig. 22, VI", "N", 0.18, largest["rms_N"]["rms_N"],
                   f"{conditions}; {sure}", f"It is so at {height['rms_N']}.",
                   structural=structural.worst_press(parent, "plain", "rms_N")),
        Comparison("the same, largest error", "Fig. 22, VI", "N", 0.61, largest["max_N"]["max_N"],
                   f"{conditions}; {sure}", f"It is so at {height['max_N']}.",
                   structural=structural.worst_press(parent, "plain", "max_N")),
        Comparison("the same, rms of all frames, flagged ones too", "Fig. 22, VI", "N", 0.18,
                   largest["rms_of_all_N"]["rms_of_all_N"], conditions,
                   f"At {height['rms_of_all_N']} a light touch reads like a heavy one near the tip. Such frames "
                   "carry the status unobservable and are not to be used; whoever uses them all the same gets this.",
                   structural=structural.worst_press(parent, "plain", "rms_of_all_N")),
    ]
    smoothed = worst((row for row in cycles if row["finger"] == "smoothed" and row["rate_Hz"] == 30),
                     key=lambda row: row["rms_of_all_N"])
    rows.append(Comparison(
        "the same, the scene says what is known of the presses", "Fig. 22, VI", "N", 0.18, smoothed["rms_of_all_N"],
        f"{conditions}; no force beyond 10 N, place and force change by about 0.2 mm and 0.1 N a frame "
        "(force_max_N, smoothing)", f"It is so at {smoothed['height_mm']:g} mm.",
        structural=structural.worst_press(parent, "known", "rms_of_all_N")))
    table = [[f"{row['rate_Hz']:g}", f"{row['height_mm']:g}", row["finger"], f"{row['rms_N']:.3f}",
              f"{row['max_N']:.3f}", f"{row['rms_of_all_N']:.3f}", f"{row['unobservable']:g} of {row['frames']:g}"]
             for row in cycles]
    return [Section(
        "Force while an object comes and goes, Fig. 22",
        "The object is pressed in to 8 N and drawn back four times in a minute, with the paper's gaps of 0.26, 0.77 "
        "and 0.14 s; nothing is controlled. The paper does not say at which height.",
        rows, [(plot(frames), "Four contacts at 70 mm, 100 frames a second, calibrated finger; gaps are frames "
                              "without a usable estimate.")],
        [("All runs", ("frames/s", "height, mm", "finger", "rms, N", "largest, N", "rms of all frames, N", "flagged"),
          table, "The paper: 0.18 N rms, 0.61 N at most.")])]

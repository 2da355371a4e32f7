"""Figs. 11 to 13: contact frames and forces on a 4 x 6 grid, forces by height."""

import statistics

from comparison import Comparison, Finding, Section, worst
from inputs import read_csv, read_yaml
import structural
from look import AFTER, BEFORE, HELD, QUIET, legend, paper_line, plt, svg

STUDY = "paper_protocol_study"
SENSED, MODEL = "noise and calibration", "kinetostatics"
NOMINAL = {SENSED: "noise, nominal finger", MODEL: "kinetostatics, nominal finger"}
SETTINGS = {  # as the table names them
    "noise only": "sensed, finger known exactly",
    "calibration only": "sensed, no noise, calibrated finger",
    SENSED: "sensed, calibrated finger",
    NOMINAL[SENSED]: "sensed, finger as drawn, gauges calibrated",
    "kinetostatics, calibration only": "kinetostatics, no noise, calibrated finger",
    MODEL: "kinetostatics, calibrated finger",
    NOMINAL[MODEL]: "kinetostatics, finger as drawn",
}
MEANS = {"place_mean_mm": "place", "angle_mean_deg": "angle", "force_error_mean_N": "force"}
ONLY_WHAT_IS_PUT_IN = (
    "The paper's figure holds the error of its image processing and whatever the real finger has and "
    "the model lacks; ours holds only what is put in.")


def means(grid, setting):
    rows = [row for row in grid if row["setting"] == setting]
    result = {name: statistics.fmean(row[column] for row in rows) for column, name in MEANS.items()}
    result["force percent"] = 100 * statistics.fmean(row["force_error_mean_N"] / row["force_N"]
                                                     for row in rows)
    return result


def plot_grid(grid):
    """Mean errors of place over height, one mark a force."""
    figure, all_axes = plt.subplots(1, 3, figsize=(9.4, 3.3))
    columns = (("place_mean_mm", "mean error of place (mm)", ((0.58, AFTER), (0.70, BEFORE))),
               ("angle_mean_deg", "mean error of angle (deg)", ((1.24, AFTER), (1.21, BEFORE))),
               ("force_error_mean_N", "mean error of force (N)", ((0.15, AFTER),)))
    for axes, (column, label, papers) in zip(all_axes, columns):
        for setting, name, colour, marker, shift in (
                (SENSED, "sensed", AFTER, "o", -1.5), (MODEL, "kinetostatics", BEFORE, "^", 1.5)):
            if setting == MODEL and column == "force_error_mean_N":
                continue
            rows = [row for row in grid if row["setting"] == setting]
            axes.scatter([row["height_mm"] + shift for row in rows], [row[column] for row in rows],
                         s=14, color=colour, marker=marker, lw=0, alpha=0.75, label=name)
        for value, colour in papers:
            axes.axhline(value, color=colour, lw=1.1, ls=(0, (4, 3)), zorder=1)
        axes.set(xlabel="height of the circle (mm)", ylabel=label, yscale="log")
        axes.set_xticks(range(30, 106, 15))
        axes.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    legend(all_axes[0], 2)
    return svg(figure, "Errors of the contact frames over the grid")


def plot_frames(frames):
    """Fig. 11: contact frames as they are and as they are found, one draw."""
    figure, all_axes = plt.subplots(1, 2, figsize=(9.4, 4.6), sharey=True)
    for axes, (setting, title) in zip(all_axes, ((MODEL, "kinetostatics, from the stage"),
                                                 (SENSED, "sensed, from gauges"))):
        rows = [row for row in frames if row["setting"] == setting]
        for prefix, colour, marker, size, label in (("true_", QUIET, "o", 42, "true"),
                                                    ("", AFTER, "+", 46, "found")):
            axes.scatter([row[prefix + "x_mm"] for row in rows], [row[prefix + "y_mm"] for row in rows],
                         s=size, color=colour, marker=marker, alpha=0.45 if prefix else 1,
                         lw=0 if prefix else 1.3, label=label)
        axes.set(xlabel="x of the contact (mm)", title=title)
        axes.title.set_fontsize(9.5)
        axes.set_xlim(left=-0.5)
    all_axes[0].set_ylabel("y of the contact (mm)")
    all_axes[0].legend(loc="lower right")
    return svg(figure, "Contact frames of one draw")


def plot_heights(rows):
    figure, axes = plt.subplots(figsize=(6.6, 3.4))
    for setting, name, colour, marker in (("noise only", "noise", AFTER, "o"),
                                          ("calibration only", "calibration", HELD, "s"),
                                          (SENSED, "noise and calibration", BEFORE, "^")):
        mine = [row for row in rows if row["setting"] == setting]
        axes.plot([row["height_mm"] for row in mine], [row["force_rms_N"] for row in mine],
                  color=colour, marker=marker, ms=4 if marker == "^" else 5, lw=1.2, alpha=0.85,
                  label=name)
    paper_line(axes, 0.15, "the paper's mean error, 0.15 N", at=0.72)
    axes.set(xlabel="height of the circle (mm)", ylabel="force error, rms (N)", yscale="log")
    axes.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    legend(axes, 3)
    return svg(figure, "Error of force by height")


def sections(parent):
    folder = parent / "contact_frames"
    grid = read_csv(folder / "grid.csv", ("setting", "height_mm", "force_N", *MEANS, "not_ok_percent"), STUDY)
    frames = read_csv(folder / "contact_frames.csv",
                      ("setting", "x_mm", "y_mm", "true_x_mm", "true_y_mm"), STUDY)
    heights = read_csv(folder / "by_height.csv", ("setting", "height_mm", "force_rms_N"), STUDY)
    put_in = read_yaml(folder / "conditions.yaml", ("gauge_noise_rad", "stage_std_mm", "force_sensor_std_N",
                                                    "circle_radius_mm", "nominal_error", "draws", "repeats"), STUDY)
    found = {setting: means(grid, setting) for setting in SETTINGS}
    noise = f"gauge noise {put_in['gauge_noise_rad']:g} rad"
    stage = f"stage {put_in['stage_std_mm']:g} mm"
    calibrated = (f"finger calibrated from a log of its own noise (force sensor "
                  f"{put_in['force_sensor_std_N']:g} N, {stage})")
    draws = f"{put_in['draws']:g} calibrations, noise {put_in['repeats']:g} times each"
    off = put_in["nominal_error"]
    drawn = (f"finger as drawn: EI off by {off['front_stiffness_percent']:+g} % (front), "
             f"{off['back_stiffness_percent']:+g} % (back), ribs by up to {off['largest_rib_length_mm']:.2f} mm")
    sensed_drawn = f"{noise}, gauges calibrated on a bench and zeroed, {drawn}"
    sensed = f"{noise}, {calibrated}, {draws}"
    model = f"{stage}, {calibrated}, {draws}"
    rows = [
        Comparison("contact frame from kinetostatics, mean error of place", "Fig. 11, V-B", "mm", 0.70,
                   found[MODEL]["place"], model, ONLY_WHAT_IS_PUT_IN,
                   structural=structural.mean(parent, "kinetostatics", "place_mm")),
        Comparison("contact frame from kinetostatics, mean error of angle", "Fig. 11, V-B", "deg", 1.21,
                   found[MODEL]["angle"], model, ONLY_WHAT_IS_PUT_IN,
                   structural=structural.mean(parent, "kinetostatics", "angle_deg")),
        Comparison("contact frame from kinetostatics, finger not calibrated, place", "Fig. 11, V-B", "mm", 0.70,
                   found[NOMINAL[MODEL]]["place"], f"{stage}, {drawn}",
                   ONLY_WHAT_IS_PUT_IN),
        Comparison("contact frame sensed, mean error of place", "Fig. 11, V-B", "mm", 0.58,
                   found[SENSED]["place"], sensed, ONLY_WHAT_IS_PUT_IN,
                   structural=structural.mean(parent, "sensed", "place_mm")),
        Comparison("contact frame sensed, mean error of angle", "Fig. 11, V-B", "deg", 1.24,
                   found[SENSED]["angle"], sensed, ONLY_WHAT_IS_PUT_IN,
                   structural=structural.mean(parent, "sensed", "angle_deg")),
        Comparison("contact frame sensed, finger not calibrated, place", "Fig. 11, V-B", "mm", 0.58,
                   found[NOMINAL[SENSED]]["place"], sensed_drawn,
                   f"With the finger calibrated the same noise gives {found[SENSED]['place']:.2f} mm: calibrate it."),
        Comparison("sensed force, mean error", "Fig. 12, V-B", "N", 0.15, found[SENSED]["force"], sensed,
                   ONLY_WHAT_IS_PUT_IN, structural=structural.mean(parent, "sensed", "force_N")),
        Comparison("sensed force, mean error, of the force", "Fig. 12, V-B", "%", 5,
                   found[SENSED]["force percent"], sensed, ONLY_WHAT_IS_PUT_IN,
                   structural=structural.mean(parent, "sensed", "force_percent")),
        Comparison("sensed force, finger not calibrated", "Fig. 12, V-B", "N", 0.15,
                   found[NOMINAL[SENSED]]["force"], sensed_drawn,
                   f"With the finger calibrated the same noise gives {found[SENSED]['force']:.2f} N: calibrate it."),
    ]
    by_height = {row["height_mm"]: row["force_rms_N"] for row in heights if row["setting"] == SENSED}
    quiet = worst(by_height, key=lambda height: -by_height[height])  # least, or NaN
    middle = by_height[quiet]
    noise_alone, = (row["force_rms_N"] for row in heights
                    if row["setting"] == "noise only" and row["height_mm"] == quiet)
    ends = [end(row["height_mm"] for row in grid) for end in (min, max)]
    bottom, top = ratios = [by_height[min(by_height, key=lambda height: abs(height - end))] / middle for end in ends]
    rows.append(Finding(
        "force error near base and tip over that in the middle", "Fig. 13, V-B", "3 to 4 times",
        f"{bottom:.1f} times at {ends[0]:g} mm, {top:.1f} at {ends[1]:g} mm", sensed,
        all(3 <= ratio <= 4 for ratio in ratios),
        f"What is divided by is {middle:.3f} N, at {quiet:g} mm; noise alone is {noise_alone:.3f} N there. The paper "
        "does not say at which heights it measured."))
    table = [[name, *(f"{found[setting][key]:.3f}" for key in ("place", "angle", "force")),
              f"{found[setting]['force percent']:.2f}"] for setting, name in SETTINGS.items()]
    return [Section(
        "Contact frames and forces, Figs. 11 to 13",
        f"A circle of R = {put_in['circle_radius_mm']:g} mm is pressed in at six heights and four forces, as on "
        "the paper's 4 × 6 grid. Kinetostatics computes the contact from where the stage says the circle is; "
        "sensing has four gauges. Either is compared with the contact of the finger as it is.",
        rows,
        [(plot_grid(grid), "Mean errors over the grid; four forces at each height. Dashed: the paper's means, "
                           "in the colour of the method."),
         (plot_frames(frames), "The contact frames of the first draw."),
         (plot_heights(heights), "Fig. 13: error of the sensed force by height, 1.5 to 4.5 N.")],
        [("Mean errors on the grid", ("", "place, mm", "angle, deg", "force, N", "force, %"), table,
          "The paper: kinetostatics 0.70 mm, 1.21 deg; sensed 0.58 mm, 1.24 deg, 0.15 N, about 5 %. The gauges' noise is "
          "assumed, as the paper states none; the sensed place goes with it and would be above the paper's from about "
          f"{put_in['gauge_noise_rad'] * 0.58 / found[SENSED]['place']:.2g} rad on.")])]

"""Figs. 19 and 20: five springs, and six objects from stiff to soft."""

import statistics

from comparison import Comparison, Finding, Section, count, model_error_text, worst
from inputs import folders, read_csv, read_yaml
from look import AFTER, QUIET, plt, svg

STUDY = "scripts/paper/simulate.py"
LIMIT = 15  # percent, the paper's


def stiffnesses(seed, what):
    rows = read_csv(seed / what / "stiffness.csv", ("object", "trials", "stiffness_N_per_mm", "std_N_per_mm"), STUDY)
    return {row["object"]: row for row in rows}


def trials(seed):
    return read_yaml(seed / "springs" / "compliance.yaml", ("trials",), STUDY)["trials"]


def error_percent(trial, springs):
    true = next(spring["N_per_mm"] for spring in springs if spring["name"] == trial["object"])
    return 100 * (trial["stiffness_N_per_mm"] / true - 1)


def why_trial(seeds, springs):
    """Explains the worst trial by its std and the points that its law is fitted to."""
    seed, trial = worst(((seed, trial) for seed in seeds for trial in trials(seed)),
                        key=lambda pair: abs(error_percent(pair[1], springs)))
    true = next(spring["N_per_mm"] for spring in springs if spring["name"] == trial["object"])
    points = [p for p in read_csv(seed / "springs" / "points.csv", ("object", "trial", "displacement_mm", "force_N"),
                                  STUDY, optional=("left_out",))
              if (p["object"], p["trial"]) == (trial["object"], trial["trial"])]
    fitted = [p for p in points if not p.get("left_out")]
    wrong = [p for p in fitted if p["force_N"] > 5 + true * p["displacement_mm"]]
    text = f"The worst trial ({true:g} N/mm; {trial['left_out']} points left out as they contradict the others) "
    if wrong:
        text += (f"has {len(wrong)} of {len(fitted)} points of up to {max(p['force_N'] for p in wrong):.0f} N where the "
                 f"spring has {max(true * p['displacement_mm'] for p in wrong):.1f} N at most: light touches taken for "
                 "heavy ones near the tip. It ")
    return text + (f"has a std of {100 * trial['std_N_per_mm'] / trial['stiffness_N_per_mm']:.0f} % and a chi2 of "
                   f"{trial['chi2'] / trial['dof']:.0f} per degree of freedom, by which it is weighed.")


def plot_springs(seeds, springs):
    """Forces over compressions, and found over true stiffness."""
    points = read_csv(seeds[0] / "springs" / "points.csv", ("object", "displacement_mm", "force_N"), STUDY)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.4, 3.6), width_ratios=(1.3, 1))
    for spring, marker in zip(springs, "osv^D"):
        mine = [p for p in points if p["object"] == spring["name"]][::2]
        left.scatter([p["displacement_mm"] for p in mine], [p["force_N"] for p in mine], s=6, color=AFTER,
                     marker=marker, lw=0, alpha=0.6)
        most = max(p["displacement_mm"] for p in mine)
        left.plot([0, most], [0, spring["N_per_mm"] * most], color=QUIET, lw=1)
        left.annotate(f"{spring['N_per_mm']:g} N/mm", (most, spring["N_per_mm"] * most), xytext=(4, 0),
                      textcoords="offset points", fontsize=8.5, color=QUIET, va="center")
    left.margins(x=0.16)
    left.set(xlim=(0, None), ylim=(0, None))
    left.set(xlabel="compression, sensed (mm)", ylabel="force, sensed (N)")
    most = LIMIT
    for k, spring in enumerate(springs):
        errors = [error_percent(trial, springs) for seed in seeds for trial in trials(seed)
                  if trial["object"] == spring["name"]]
        most = max([most, *map(abs, errors)])
        right.scatter([k] * len(errors), errors, s=16, color=AFTER, lw=0, alpha=0.6)
        right.hlines(statistics.fmean(errors), k - 0.25, k + 0.25, color=AFTER, lw=2)
    for side in (-LIMIT, LIMIT):
        right.axhline(side, color=QUIET, lw=1, ls=(0, (4, 3)))
    right.axhline(0, color=QUIET, lw=0.8)
    right.set_xticks(range(len(springs)), [f"{spring['N_per_mm']:g}" for spring in springs])
    right.set(xlabel="spring (N/mm)", ylabel="error of a trial (%)", ylim=(-1.15 * most, 1.15 * most))
    return svg(figure, "Springs: force over compression and error of stiffness")


def plot_objects(seeds, objects):
    figure, axes = plt.subplots(figsize=(7.4, 2.9))
    for k, item in enumerate(objects):
        found = [stiffnesses(seed, "objects")[stem(item["name"])]["stiffness_N_per_mm"] for seed in seeds]
        axes.scatter([item["N_per_mm"]], [k], s=90, color=QUIET, marker="|", lw=2, label="true" if k == 0 else None)
        axes.scatter(found, [k] * len(found), s=18, color=AFTER, lw=0, alpha=0.7, label="found" if k == 0 else None)
    axes.set(xscale="log", xlabel="stiffness between 1 and 3 N (N/mm)")
    axes.xaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(plt.NullFormatter())
    axes.set_xticks((0.5, 1, 2, 5))
    axes.set_yticks(range(len(objects)), [item["name"] for item in objects])
    axes.invert_yaxis()
    axes.legend(loc="lower right")
    return svg(figure, "Stiffness of six objects")


def stem(name):
    return name.replace(" ", "_")


def sections(folder):
    seeds = folders(folder / "stiffness", "seed_*", STUDY)
    put_in = read_yaml(seeds[0] / "conditions.yaml",
                       ("gauge_noise_rad", "stage_std_mm", "slider_friction_N", "model_error", "springs", "objects",
                        "from_N", "to_N"), "compliance_study")
    springs, objects = put_in["springs"], put_in["objects"]
    noise = (f"gauge noise {put_in['gauge_noise_rad']:g} rad, stage {put_in['stage_std_mm']:g} mm, "
             f"{model_error_text(put_in['model_error'])}, anew for every trial")
    friction = f"slider friction {put_in['slider_friction_N']:g} N"
    spring_rows, mean_errors, trial_errors = [], [], []
    for spring in springs:
        true = spring["N_per_mm"]
        means = [stiffnesses(seed, "springs")[spring["name"]]["stiffness_N_per_mm"] / true - 1 for seed in seeds]
        mean_error = 100 * worst(map(abs, means))
        trial_error = worst(abs(error_percent(trial, springs)) for seed in seeds for trial in trials(seed)
                            if trial["object"] == spring["name"])
        mean_errors.append(mean_error)
        trial_errors.append(trial_error)
        spring_rows.append([f"{true:g}", f"{true * (1 + statistics.fmean(means)):.3f}", f"{mean_error:.2f}",
                            f"{trial_error:.2f}"])
    why = why_trial(seeds, springs)
    rows = [
        Comparison("five springs, five trials each, error of the mean stiffness, worst spring and draw",
                   "Fig. 19, V-D", "%", LIMIT, worst(mean_errors),
                   f"20 steps of 1 mm in and out, {friction}, {noise}, {count(len(seeds), 'draw')}", why, limit=True),
        Comparison("the same, error of a single trial, worst of all", "Fig. 19, V-D", "%", LIMIT, worst(trial_errors),
                   f"as above, {len(seeds) * 5} trials a spring", why, limit=True)]

    orders, confidences, object_rows = 0, [], []
    for seed in seeds:
        found = stiffnesses(seed, "objects")
        orders += list(found) == [stem(item["name"]) for item in objects]
        confidences.append(read_yaml(seed / "objects" / "compliance.yaml", ("order_confidence",),
                                     STUDY)["order_confidence"])
    for item in objects:
        found = [stiffnesses(seed, "objects")[stem(item["name"])]["stiffness_N_per_mm"] for seed in seeds]
        errors = [100 * abs(value / item["N_per_mm"] - 1) for value in found]
        object_rows.append([item["name"], f"{item['N_per_mm']:.3f}", f"{statistics.fmean(found):.3f}",
                            f"{worst(errors):.1f}"])
    rows.append(Finding(
        "six objects between two fingers, sorted from stiff to soft", "Fig. 20, V-D", "order as volunteers feel it",
        f"right in {orders} of {count(len(seeds), 'draw')}",
        f"the objects' force laws are assumed by us, in the paper's order; one squeeze each to 4 N, {noise}, two "
        f"fingers of different error; mean stated confidence of the whole order "
        f"{100 * statistics.fmean(confidences):.0f} %",
        orders == len(seeds), "One squeeze with this noise and model error does not tell all neighbours apart."))
    return [Section(
        "Stiffness of springs and objects, Figs. 19 and 20",
        "The finger pushes a slider on a spring; two fingers squeeze things whose force laws are assumed, in the "
        "paper's order, as it gives no stiffness of them. Way and force both come from the sensed contact.",
        rows,
        [(plot_springs(seeds, springs),
          "Springs. Left: what was sensed in the first draw, and the true springs as lines; the slider's friction is on "
          "either side. Right: errors of all trials and their mean; dashed: 15 %."),
         (plot_objects(seeds, objects), "Six objects, one squeeze in each draw.")],
        [("Springs", ("true, N/mm", "mean found, N/mm", "largest error of a mean of five, %",
                      "largest error of a trial, %"), spring_rows, "The paper: below 15 %."),
         ("Objects", ("object", "true, 1 to 3 N, N/mm", "mean found, N/mm", "largest error, %"), object_rows,
          "The paper gives the order only.")])]

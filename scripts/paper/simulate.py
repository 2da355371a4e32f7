#!/usr/bin/python3
"""Simulates the paper's experiments: simulate.py [--quick] BUILD_DIR OUT_DIR.

Every experiment leaves CSV and YAML in a folder of its own below OUT_DIR, which
report.py turns into a page. Seeds are fixed; --quick takes fewer of them.
"""

import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("simulate.py", __name__)

ROOT = pathlib.Path(__file__).resolve().parents[2]
FINGER = ROOT / "configs" / "fingers" / "paper_140mm.yaml"
SCENES = ROOT / "configs" / "scenes"
CONTROL = ("fixed_harmonic", "fixed_step", "moving_harmonic", "moving_triangular", "two_finger",
           "two_finger_ramped")
# What finray_reconstruct says, by exit code, when it refuses touches.
REFUSALS = {2: "too few touches: ", 4: "badly spread touches: "}
FOLDERS = ("contact_frames", "force_sensing", "outlines", "stiffness", "force_control", "structural")
MARKER = ".paper_experiments"  # in folders that a run may delete
PATTERNS = "*?[]{},\\"  # what --logs reads as patterns or as the end of a name


class Failed(Exception):
    pass


def run(*words, refusals=None):
    """The output of the tool, or None where it refuses for an accepted reason."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True)
    if done.returncode == 0:
        return done.stdout
    last = (done.stderr.strip().splitlines() or ["no message"])[-1]
    if refusals and done.returncode in refusals and refusals[done.returncode] in last:
        return None
    raise Failed(f"{pathlib.Path(words[0]).name}: {last} (exit code {done.returncode})")


def flags(**values):
    return [f"--{name}={value}" for name, value in values.items()]


def contact_frames(build, out, draws):
    run(build / "tests" / "paper_protocol_study", out / "contact_frames", draws)


def force_sensing(build, out):
    run(ROOT / "scripts" / "studies" / "contact_cycles.py", build, out / "force_sensing")


def calibrated(path):
    """Writes the finger that the estimator has: the nominal one, with the std of the
    errors that the studies draw, as finray_calibrate leaves a finger."""
    ribs, gauges = range(1, 6), range(1, 5)
    std = {"front_stiffness_N_mm2": 125, "back_stiffness_N_mm2": 125,
           **{f"gauge_{j}_gain_V_per_rad": 0.003 for j in gauges},
           **{f"rib_{i}_length_mm": 0.03 for i in ribs}}
    path.write_text(f"{FINGER.read_text('utf-8')}calibration:\n  parameters: [{', '.join(std)}]\n"
                    f"  std: [{', '.join(map(str, std.values()))}]\n")
    return path


def outlines(build, out, seed):
    """Reconstructs each object with one contact known to be there, as in the paper's
    model, and with `contacts: auto`. A refused one leaves no folder."""
    folder = out / "outlines" / f"seed_{seed}"
    run(build / "tests" / "reconstruction_study", "write", folder, seed)
    finger = calibrated(folder / "calibrated_finger.yaml")
    single = folder / "single_contact.yaml"
    single.write_text("schema_version: 1\ncontacts: 1\n")
    for log in sorted(folder.glob("*.touches.csv")):
        name = log.name[:-len(".touches.csv")]
        for kind, scene in (("single", single), ("auto", SCENES / "auto.yaml")):
            run(build / "finray_reconstruct",
                *flags(finger=finger, scene=scene, logs=log, truth=folder / f"{name}.outline.csv",
                       plots="false", out_dir=folder / kind / name),
                refusals=REFUSALS if kind == "auto" else None)


def stiffness(build, out, seed):
    folder = out / "stiffness" / f"seed_{seed}"
    run(build / "tests" / "compliance_study", "write", folder, seed)
    finger = calibrated(folder / "calibrated_finger.yaml")
    common = dict(finger=finger, scene=SCENES / "pulley.yaml", direction_deg=180, plots="false")
    run(build / "finray_compliance",
        *flags(**common, logs=folder / "spring_*.csv", most_degree=1, out_dir=folder / "springs"))
    run(build / "finray_compliance",
        *flags(**common, logs=folder / "*.left.csv", second_logs=folder / "*.right.csv", from_N=1, to_N=3,
               out_dir=folder / "objects"))


def structural(build, out, seed):
    run(ROOT / "scripts" / "paper" / "structural_plant.py", build, out / "structural" / f"seed_{seed}", seed)


def force_control(build, out, name, draws):
    run(build / "finray_control",
        *flags(finger=FINGER, experiment=ROOT / "configs" / "control" / f"{name}.yaml", draws=draws,
               out_dir=out / "force_control" / name))


def tasks(build, out, quick):
    """The experiments, long ones first so that none is left over at the end."""
    seeds = range(1, 2 if quick else 6)
    yield contact_frames, (build, out, 10 if quick else 100)
    for name in CONTROL:
        yield force_control, (build, out, name, 2 if quick else 10)
    for seed in seeds:
        yield outlines, (build, out, seed)
        yield stiffness, (build, out, seed)
        yield structural, (build, out, seed)
    yield force_sensing, (build, out)


def prepare(out):
    """Deletes the results of an earlier run, which may have had more seeds. Refuses a
    folder without the mark of a run and leaves it alone."""
    wrong = sorted(set(PATTERNS) & set(str(out)))
    if wrong:
        raise Failed(f"OUT_DIR {out}: {' '.join(wrong)} in a name cannot be told from a pattern of logs; expected a "
                     f"name without any of {PATTERNS}")
    old = [out / name for name in FOLDERS if os.path.lexists(out / name)]
    for folder in old:
        if folder.is_symlink() or not (folder / MARKER).is_file():
            raise Failed(f"{folder}: there already and not marked as an earlier run's (no file {MARKER} in it); move "
                         "it away or take another OUT_DIR")
    for folder in old:
        shutil.rmtree(folder)
    for name in ("report.html", "table.md"):
        (out / name).unlink(missing_ok=True)
    for name in FOLDERS:
        (out / name).mkdir(parents=True)
        (out / name / MARKER).write_text("scripts/paper_experiments deletes this folder when it runs again.\n")


def main():
    parser = guard.Parser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        prepare(arguments.out)
    except (Failed, OSError) as error:
        print(f"paper_experiments: {error}", file=sys.stderr)
        sys.exit(2)
    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        running = {pool.submit(task, *words): " ".join([task.__name__, *map(str, words[2:])])
                   for task, words in tasks(arguments.build, arguments.out, arguments.quick)}
        for done in concurrent.futures.as_completed(running):
            try:
                done.result()
            except (Failed, OSError) as error:
                pool.shutdown(wait=True, cancel_futures=True)
                sys.exit(f"paper_experiments: {running[done]}: {error}")
            print(f"{time.monotonic() - start:5.0f} s  {running[done]}", flush=True)


if __name__ == "__main__":
    main()

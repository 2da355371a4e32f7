"""The input files of every executable, good ones, and its arguments."""

import pathlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def first_lines(path, count):
    return b"".join((SOURCE / path).read_bytes().splitlines(keepends=True)[:count])


FINGER = (SOURCE / "configs/fingers/paper_140mm.yaml").read_bytes()
SCENE = b"contacts: auto\nobject: {shape: circle, radius_mm: 15}\n"
PLAN = (SOURCE / "configs/plans/force_and_circle.yaml").read_bytes()
EXPERIMENT = (SOURCE / "configs/control/fixed_step.yaml").read_bytes()
CALIBRATION = b"""schema_version: 1
parameters:
  - {name: front_stiffness_N_mm2, unit: N mm^2, value: 12500, std: 95, status: estimated}
correlations: {names: [front_stiffness_N_mm2], matrix: [[1]]}
inputs: {logs: [{path: a.csv, sha256: 00}]}
"""
LOADS = b"contact_1_mm,normal_1_N\n50,2\n60.5,1\n"
LOG = first_lines("datasets/simulated_r15/holdout.csv", 6)
SPRING = (SOURCE / "datasets/springs/spring_0.5_1.csv").read_bytes()
TOUCHES = (SOURCE / "datasets/touches_square/touches.csv").read_bytes()
OUTLINE = (SOURCE / "datasets/touches_square/outline.csv").read_bytes()

RESULT = (b"time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,contact_1_mm,normal_1_N,status\n"
          b"0,0.01,0.02,0.03,0.02,50,2,ok\n1,0,0,0,0,,0,no_contact\n")

# Each executable: its input files, good ones, and its arguments.
APPS = {
    "simulate": ({"finger.yaml": FINGER, "scene.yaml": SCENE, "in.csv": LOADS},
                 "--finger finger.yaml --scene scene.yaml --frames in.csv --out out"),
    "estimate": ({"finger.yaml": FINGER, "scene.yaml": SCENE, "log.csv": LOG},
                 "--finger finger.yaml --scene scene.yaml --logs log.csv --out_dir out"),
    "calibrate": ({"finger.yaml": FINGER, "plan.yaml": PLAN, "log.csv": LOG},
                  "--finger finger.yaml --plan plan.yaml --logs log.csv --out_dir out"
                  " --report=false"),
    "validate": ({"finger.yaml": FINGER, "scene.yaml": SCENE, "log.csv": LOG},
                 "--finger finger.yaml --scene scene.yaml --logs log.csv --out_dir out"),
    "compare": ({"finger.yaml": FINGER, "calibration.yaml": CALIBRATION},
                "calibration.yaml calibration.yaml --out_dir out"),
    "compliance": ({"finger.yaml": FINGER, "scene.yaml": SCENE, "log.csv": SPRING},
                   "--finger finger.yaml --scene scene.yaml --logs log.csv --out_dir out"
                   " --noplots"),
    "reconstruct": ({"finger.yaml": FINGER, "log.csv": TOUCHES, "truth.csv": OUTLINE},
                    "--finger finger.yaml --logs log.csv --truth truth.csv --out_dir out"
                    " --noplots"),
    "view": ({"finger.yaml": FINGER, "a.frames.csv": RESULT},
             "--finger finger.yaml --results a.frames.csv --out_dir out"),
    "control": ({"finger.yaml": FINGER, "experiment.yaml": EXPERIMENT},
                "--finger finger.yaml --experiment experiment.yaml --out_dir out"
                " --draws 1"),
}

#!/usr/bin/python3
"""Calibrates and estimates every log: evaluate.py BUILD_DIR LOGS_DIR OUT_DIR

LOGS_DIR has <finger>/<world>/{train,holdout}.csv and their truth (make_logs.py).
Writes OUT_DIR/outcomes.json. A finger is calibrated with the bundled plan and with
each datasets/reality/<finger>/plan_*.yaml, which may have a finger_*.yaml of its own;
the control has one of them alone.
"""

import json
import pathlib
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("evaluate.py", __name__)

import yaml

import plant as plants
import same_model
from make_logs import BUNDLED, FRICTIONS, HEIGHTS, ROOT
from outcome import Failed, outcome

sys.path.append(str(ROOT / "calib" / "report"))
import whole_file

SCENE = ROOT / "configs" / "scenes" / "auto.yaml"
BUNDLED_PLAN = ROOT / "configs" / "plans" / "force_and_circle.yaml"
# Whose model has an equal plant in finray (rigid ribs on hinges), and the control's plan.
CONTROLS = {"strip": "thickness"}


def drawing_of(finger, plan):
    """A plan may have a drawing of its own."""
    own = BUNDLED / finger / f"finger_{plan}.yaml"
    return own if own.exists() else BUNDLED / finger / "finger.yaml"


def cases(build, logs, out):
    """(finger, world, folder of its logs, name of the plan, plan)."""
    for finger in HEIGHTS:
        plans = [("bundled", BUNDLED_PLAN)] + [(path.stem.removeprefix("plan_"), path)
                                               for path in sorted((BUNDLED / finger).glob("plan_*.yaml"), reverse=True)]
        if finger in CONTROLS:
            drawing = yaml.safe_load((BUNDLED / finger / "finger.yaml").read_text("utf-8"))
            control = out / finger / "same_model"
            same_model.make(build, plants.read(BUNDLED / finger / "plant.yaml"), drawing,
                            logs / finger / "smooth", control)
            yield finger, "same model", control, CONTROLS[finger], dict(plans)[CONTROLS[finger]]
        for world in FRICTIONS:
            for name, plan in plans:
                yield finger, world, logs / finger / world, name, plan


def main():
    build, logs, out = (pathlib.Path(argument).resolve() for argument in guard.words(__doc__, 3, 3))
    found = []
    try:
        for finger, world, folder, name, plan in cases(build, logs, out):
            result = outcome(build, drawing_of(finger, name), plan, folder,
                             plants.read(BUNDLED / finger / "plant.yaml"), SCENE,
                             out / finger / world.replace(" ", "_") / name)
            found.append({"finger": finger, "world": world, "plan": name, **result})
            words = result.get("refused") or f"{result['verdict']}, force {result['force']['rms']:.3f} N rms"
            print(f"{finger}, {world}, {name}: {words}", flush=True)
    except (OSError, Failed) as error:
        print(f"evaluate.py: {error}", file=sys.stderr)
        sys.exit(2)
    whole_file.write(out / "outcomes.json", json.dumps(found, indent=1))


if __name__ == "__main__":
    main()

"""GNU Octave's fsolve on the paper's equations (octave_peer.m), forward."""

import json
import pathlib
import shutil
import subprocess

import numpy as np

from chain_model import Chain
from run import NotInstalled

LINKS = 40


def arrays(chain):
    return {"n": chain.n, "steps": chain.steps.tolist(), "joints": chain.joints.tolist(),
            "last": chain.end.tolist(), "front_mid": chain.front_mid.tolist(),
            "stiffness": chain.stiffness.tolist(), "rib_length": chain.rib_length.tolist(),
            "left_link": [link for link, _ in chain.left],
            "left_rest": [list(map(float, rest)) for _, rest in chain.left],
            "right_link": [link for link, _ in chain.right],
            "right_rest": [list(map(float, rest)) for _, rest in chain.right]}


def run(job, folder):
    if shutil.which("octave-cli") is None:
        raise NotInstalled("octave is not installed")
    chain = Chain(job["finger"], LINKS)
    settings, version = [], ""
    for scene in job["scenes"][:1]:  # many seconds a frame
        loads = [{"contact": f["contact_mm"] / chain.unit, "force": f["normal_N"] / chain.force,
                  "friction": f["friction"]} for f in scene["frames"]]
        (folder / "chain.json").write_text(json.dumps({"chain": arrays(chain), "loads": loads}))
        script = pathlib.Path(__file__).with_suffix(".m")
        subprocess.run(["octave-cli", "--norc", "--quiet", str(script), str(folder)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        found = json.loads((folder / "octave.json").read_text("utf-8"))
        version = f"Octave {found['version']}"
        answers = [chain.answer(np.ravel(s["x"]), load["contact"], load["force"],
                                s["iterations"], s["solved"])
                   for s, load in zip(found["solutions"], loads)]
        settings.append({
            "task": "forward", "scene": scene["scene"], "solver": f"octave{LINKS}",
            "words": f"Octave fsolve on the paper's chain, n = {chain.n}",
            "links": chain.n, "unknowns": chain.unknowns(), "answers": answers,
            "time_us": [1e6 * found["seconds"] / len(loads)]})
    return {"version": version, "settings": settings}

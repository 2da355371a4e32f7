#!/usr/bin/python3
"""Asks another program for the answers that finray_benchmark compares with.

run.py PEER FOLDER reads FOLDER/job.json (libfinray/finray/benchmark/peers.h) and
writes FOLDER/answer.json: {version, skipped, settings}; a setting has an answer a
frame and the time a frame, by the clock, of every repeat.
"""

import importlib
import json
import pathlib
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("peers", __name__)

MODULES = {"scipy": "scipy_peer", "octave": "octave_peer", "calculix": "calculix_peer",
           "getfem": "getfem_peer", "mujoco": "mujoco_peer"}
# Debian's packages of modules that are not called python3-MODULE.
PACKAGES = {"getfem": "python3-getfem++"}


class NotInstalled(Exception):
    """A peer's program is missing; the message says what to install."""


def main():
    peer, folder = guard.words(__doc__, 2, 2)
    folder = pathlib.Path(folder).resolve()
    job = json.loads((folder / "job.json").read_text("utf-8"))
    sys.modules["run"] = sys.modules["__main__"]
    try:
        module = importlib.import_module(MODULES[peer])
        answer = {"skipped": "", **module.run(job, folder)}
    except ImportError as error:
        name = error.name.split(".")[0] if error.name else "a package"
        package = PACKAGES.get(name, f"python3-{name}")
        answer = {"version": "", "skipped": f"{package} is not installed", "settings": []}
    except NotInstalled as error:
        answer = {"version": "", "skipped": str(error), "settings": []}
    (folder / "answer.json").write_text(json.dumps(answer), "utf-8")


if __name__ == "__main__":
    main()

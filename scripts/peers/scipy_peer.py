"""scipy.optimize.least_squares on the paper's equations, Jacobian by differences."""

import time

import numpy as np
import scipy
from scipy.optimize import least_squares

from chain_model import Chain

MODEL_WEIGHT = 1e3  # of the model's rows against the gauges' in rad
SOLVED = 1e-6


def forward(chain, start, contact, force, friction):
    """Solves from the straight finger, and by shares of the load where that fails."""
    for steps in (1, 4, 16):
        x, count = start.copy(), 0
        for share in np.arange(1, steps + 1) / steps:
            found = least_squares(lambda u: chain.model(u, contact, share * force, friction), x,
                                  method="lm", xtol=1e-10, ftol=1e-12)
            x, count = found.x, count + found.nfev
        if np.abs(found.fun).max() < SOLVED:
            return x, count, True
    return x, count, False


def sense(chain, start, frame, measured):
    def rows(u):
        model = chain.model(u[:-2], u[-2], u[-1], frame["friction"])
        return np.concatenate([MODEL_WEIGHT * model, chain.gauges @ u[:chain.n] - measured])

    found = least_squares(rows, start, method="lm", xtol=1e-10, ftol=1e-12)
    held = np.abs(found.fun[:-len(measured)]).max() < MODEL_WEIGHT * 1e-4
    return found.x, found.nfev, held and found.status > 0


def run(job, folder):
    del folder
    settings = []
    repeats = 1 if job["quick"] else 2
    for links in (40,) if job["quick"] else (40, 100):
        chain = Chain(job["finger"], links)
        straight = np.zeros(chain.unknowns())
        for scene in job["scenes"]:
            cases = [(f, f["contact_mm"] / chain.unit, f["normal_N"] / chain.force)
                     for f in scene["frames"]]
            # With differences, sensing with 100 links takes about a minute a frame.
            for task in ("forward", "sensing") if links < 100 else ("forward",):
                times = []
                for _ in range(repeats):
                    answers, spent = [], 0
                    for frame, contact, force in cases:
                        if task == "forward":
                            begin = time.perf_counter()
                            x, count, solved = forward(chain, straight, contact, force,
                                                       frame["friction"])
                            spent += time.perf_counter() - begin
                        else:
                            first = (frame["start_mm"] / chain.unit, frame["start_N"] / chain.force)
                            x, _, _ = forward(chain, straight, *first, frame["friction"])
                            begin = time.perf_counter()
                            x, count, solved = sense(chain, np.concatenate([x, first]), frame,
                                                     np.array(frame["measured_rad"]))
                            spent += time.perf_counter() - begin
                            contact, force = x[-2:]
                        # Count Jacobians: evaluations over those of one Jacobian by differences.
                        count = round(count / (len(x) + 1))
                        answers.append(chain.answer(x, contact, force, count, solved))
                    times.append(1e6 * spent / len(cases))
                settings.append({
                    "task": task, "scene": scene["scene"], "solver": f"scipy{links}",
                    "words": f"SciPy least_squares on the paper's chain, n = {chain.n}",
                    "links": chain.n,
                    "unknowns": chain.unknowns() + (2 if task == "sensing" else 0),
                    "answers": answers, "time_us": times})
    return {"version": f"SciPy {scipy.__version__}, numpy {np.__version__}", "settings": settings}

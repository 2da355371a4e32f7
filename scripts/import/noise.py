"""How noisy a channel is, from neighbouring readings, whatever slow motion is in it."""

import numpy as np

# A fifth of a normal variable's magnitudes are below this many std.
FIFTH = 0.2533


def reading_std(values):
    """Std of one reading, from the smallest fifth of the second differences: those of rest
    and of slow motion. Not below what the steps of a converter bring."""
    values = values[np.isfinite(values)]
    if len(values) < 8:
        return 0.0
    steps = np.abs(np.diff(values))
    second = np.abs(values[2:] - 2 * values[1:-1] + values[:-2])
    quantum = np.min(steps[steps > 0], initial=np.ptp(values)) / np.sqrt(12)
    return float(max(np.quantile(second, 0.2) / FIFTH / np.sqrt(6), quantum))


def mean_std_factor(runs):
    """Std of the mean of a run over std / sqrt(n), from the correlation of neighbours."""
    products = squares = 0.0
    for run in runs:
        if len(run) < 3:
            continue
        run = run - run.mean()
        # The mean that is taken off makes the correlation about 1/n too small.
        products += run[1:] @ run[:-1] + run @ run / len(run)
        squares += run @ run
    r = min(max(products / squares, 0.0), 0.99) if squares > 0 else 0.0
    return float(np.sqrt((1 + r) / (1 - r)))

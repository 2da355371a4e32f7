"""How noisy a channel is, from neighbouring readings, whatever slow motion is in it."""

import numpy as np


def reading_std(values):
    """Std of one reading: the median of third differences, over that of unit noise.

    Motion that is smooth over four readings drops out, and so do a few jumps.
    """
    values = values[np.isfinite(values)]
    if len(values) < 8:
        return 0.0
    third = values[3:] - 3 * values[2:-1] + 3 * values[1:-2] - values[:-3]
    return float(np.median(np.abs(third)) / 0.6745 / np.sqrt(20))


def mean_std_factor(runs):
    """Std of the mean of a run over std / sqrt(n), from the correlation of neighbours."""
    products = squares = 0.0
    for run in runs:
        run = run[np.isfinite(run)]
        if len(run) < 3:
            continue
        run = run - run.mean()
        # The mean that is taken off makes the correlation about 1/n too small.
        products += run[1:] @ run[:-1] + run @ run / len(run)
        squares += run @ run
    r = min(max(products / squares, 0.0), 0.99) if squares > 0 else 0.0
    return float(np.sqrt((1 + r) / (1 - r)))

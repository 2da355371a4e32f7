"""Sums over errors."""

import math


def rms(errors):
    return math.sqrt(sum(e * e for e in errors) / len(errors)) if errors else math.nan


def mean(errors):
    return sum(errors) / len(errors) if errors else math.nan

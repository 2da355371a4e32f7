"""NPZ of numpy: every array is a column, or several of them."""

import numpy as np

import arrays
import limits


def read(path):
    limits.refuse_large_zip(path)
    with np.load(path, allow_pickle=False) as file:
        if not hasattr(file, "files"):
            raise ValueError("one bare array has no names; save it with numpy.savez")
        return arrays.tables(path, "", {name: file[name] for name in file.files})

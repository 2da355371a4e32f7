"""MAT of MATLAB and Octave: vectors of the workspace, and structs of vectors as parts.

Versions 4 to 7.2 are read by scipy, version 7.3 is HDF5.
"""

import numpy as np
import scipy.io

import arrays


def read(path):
    with open(path, "rb") as file:
        if b"MATLAB 7.3" in file.read(128):
            import hdf5_reader  # needs h5py, which the other versions do not

            return hdf5_reader.read(path)
    loaded = scipy.io.loadmat(path, squeeze_me=True, struct_as_record=False,
                              chars_as_strings=True)
    plain, tables = {}, []
    for name, value in loaded.items():
        if name.startswith("__"):
            continue
        if isinstance(value, scipy.io.matlab.mat_struct):
            fields = {field: np.asarray(getattr(value, field)) for field in value._fieldnames}
            tables += arrays.tables(path, name, fields)
        else:
            plain[name] = np.asarray(value)
    return arrays.tables(path, "", plain) + tables

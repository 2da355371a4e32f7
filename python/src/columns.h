#ifndef FINRAY_PYTHON_SRC_COLUMNS_H_
#define FINRAY_PYTHON_SRC_COLUMNS_H_

#include <pybind11/pybind11.h>

#include <string>

#include "finray/table.h"

namespace finray_python {

/// A table of a dict from names to columns, as finray/tables.py makes them:
/// aligned one-dimensional arrays of float64, which are borrowed and kept
/// alive, or lists of str. Throws InputError as Table does.
finray::Table FromDict(const pybind11::dict& columns, const std::string& name);

/// The columns of a table as NumPy arrays that share its memory; text as lists.
pybind11::dict ToDict(const finray::Table& table);

}  // namespace finray_python

#endif  // FINRAY_PYTHON_SRC_COLUMNS_H_

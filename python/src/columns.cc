#include "columns.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "finray/error.h"

namespace py = pybind11;

namespace finray_python {
namespace {

// Keeps a Python object until the last table that uses it is gone, on any
// thread.
std::shared_ptr<const void> Owner(py::object object) {
  return std::shared_ptr<py::object>(new py::object(std::move(object)),
                                     [](py::object* held) {
                                       const py::gil_scoped_acquire gil;
                                       delete held;
                                     });
}

py::array OneDimensional(const std::string& name, const py::handle& values) {
  py::array array = py::array::ensure(values);
  if (array && array.ndim() == 1) return array;
  PyErr_Clear();
  throw finray::InputError(
      "column '" + name + "': expected a one-dimensional array" +
      (array
           ? ", found one with " + std::to_string(array.ndim()) + " dimensions"
           : ""));
}

bool IsWhole(const py::array& array) {
  return py::isinstance<py::array_t<double>>(array) &&
         array.strides(0) % static_cast<py::ssize_t>(sizeof(double)) == 0;
}

}  // namespace

finray::Table FromDict(const py::dict& columns, const std::string& name) {
  std::size_t rows = 0;
  if (!columns.empty()) {
    const auto& [key, values] = *columns.begin();
    rows =
        static_cast<std::size_t>(OneDimensional(py::str(key), values).shape(0));
  }
  finray::Table table(rows, name);
  for (const auto& [key, values] : columns) {
    const std::string column = py::str(key);
    py::array array = OneDimensional(column, values);
    const char kind = array.dtype().kind();
    if (kind == 'U' || kind == 'O' || kind == 'S') {
      std::vector<std::string> texts;
      for (const py::handle& value : array) {
        texts.push_back(value.is_none() ? "" : std::string(py::str(value)));
      }
      table.SetText(column, std::move(texts));
      continue;
    }
    if (!IsWhole(array)) {
      array = py::array_t<double, py::array::forcecast>::ensure(array);
      if (!array) {
        PyErr_Clear();
        throw finray::InputError("column '" + column +
                                 "': expected numbers or text");
      }
    }
    const auto stride =
        array.size() > 1
            ? array.strides(0) / static_cast<py::ssize_t>(sizeof(double))
            : 1;
    table.Borrow(column,
                 {static_cast<const double*>(array.data()),
                  static_cast<std::size_t>(array.size()), stride},
                 Owner(array));
  }
  return table;
}

py::dict ToDict(const finray::Table& table) {
  const auto shared = std::make_shared<finray::Table>(table);
  py::dict columns;
  for (const std::string& name : table.columns()) {
    if (table.IsText(name)) {
      columns[py::str(name)] = py::cast(table.TextAt(name));
      continue;
    }
    const finray::Numbers numbers = table.At(name);
    using Held = std::shared_ptr<finray::Table>;
    const py::capsule keep(new Held(shared),
                           [](void* held) { delete static_cast<Held*>(held); });
    columns[py::str(name)] = py::array_t<double>(
        {static_cast<py::ssize_t>(numbers.size)},
        {numbers.stride * static_cast<py::ssize_t>(sizeof(double))},
        numbers.values, keep);
  }
  return columns;
}

}  // namespace finray_python

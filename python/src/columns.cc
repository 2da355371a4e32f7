#include "columns.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "finray/error.h"

namespace py = pybind11;

namespace finray_python {
namespace {

constexpr int kAligned = py::detail::npy_api::NPY_ARRAY_ALIGNED_;

// Keeps a Python object until the last table that uses it is gone, on any
// thread.
std::shared_ptr<const void> Owner(py::object object) {
  return std::shared_ptr<py::object>(new py::object(std::move(object)),
                                     [](py::object* held) {
                                       const py::gil_scoped_acquire gil;
                                       delete held;
                                     });
}

// A column in place: whole doubles at a step of whole doubles.
py::array InPlace(const std::string& column, const py::handle& values) {
  constexpr auto kDouble = static_cast<py::ssize_t>(sizeof(double));
  if (py::isinstance<py::array_t<double>>(values)) {
    auto array = py::reinterpret_borrow<py::array>(values);
    if (array.ndim() == 1 && (array.flags() & kAligned) != 0 &&
        array.strides(0) % kDouble == 0) {
      return array;
    }
  }
  throw finray::InputError("column '" + column +
                           "': expected aligned doubles in one dimension");
}

}  // namespace

finray::Table FromDict(const py::dict& columns, const std::string& name) {
  const std::size_t rows =
      columns.empty() ? 0 : py::len((*columns.begin()).second);
  finray::Table table(rows, name);
  for (const auto& [key, values] : columns) {
    const std::string column = py::str(key);
    if (py::isinstance<py::list>(values)) {
      table.SetText(column, values.cast<std::vector<std::string>>());
      continue;
    }
    const py::array array = InPlace(column, values);
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

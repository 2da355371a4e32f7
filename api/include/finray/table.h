#ifndef FINRAY_TABLE_H_
#define FINRAY_TABLE_H_

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "finray/export.h"

namespace finray::v1 {

class Scene;

/// The numbers of a column. They stay valid as long as a table holds them.
struct Numbers {
  const double* values = nullptr;
  std::size_t size = 0;
  std::ptrdiff_t stride = 1;  ///< In doubles, from one value to the next.

  double operator[](std::size_t i) const {
    return values[static_cast<std::ptrdiff_t>(i) * stride];
  }
};

/// A table of frames, one row a frame: a log, or the result of one. Columns
/// have the names of the frame table (docs/reference/formats.md): time_s,
/// `gauge_<j>_V`, `contact_<c>_mm`, `normal_<c>_N`, force_N, ... A NaN means
/// not measured. `status` and columns of other names hold text. Copies share
/// their columns.
class FINRAY_API Table {
 public:
  /// `name` stands for the path in messages.
  explicit Table(std::size_t rows = 0, const std::string& name = "the table");
  ~Table();
  Table(const Table&);
  Table& operator=(const Table&);
  Table(Table&&) noexcept;
  Table& operator=(Table&&) noexcept;

  /// Reads a .csv or .csv.gz. A scene renames columns by its `columns`. Throws
  /// InputError (file:line:column).
  static Table Read(const std::string& path);
  static Table Read(const std::string& path, const Scene& scene);
  /// Writes CSV that reads back as the same doubles; gzipped if the name ends
  /// in .gz. The file appears as a whole. Throws InputError.
  void Write(const std::string& path) const;
  std::string ToCsv() const;

  const std::string& name() const;
  std::size_t rows() const;
  std::vector<std::string> columns() const;
  bool Has(const std::string& column) const;
  bool IsText(const std::string& column) const;

  /// The numbers of a column. Throws InputError if there is none, with the
  /// nearest name, or if it holds text.
  Numbers At(const std::string& column) const;
  /// The texts of a column. Throws InputError if there is none or if it holds
  /// numbers.
  const std::vector<std::string>& TextAt(const std::string& column) const;

  /// Put a column, in place of one of the same name or behind the last. Throw
  /// InputError if it does not have as many values as the table has rows, or if
  /// a column of the frame table gets text.
  void Set(const std::string& column, std::vector<double> values);
  void SetText(const std::string& column, std::vector<std::string> texts);
  /// Puts a column whose numbers belong to the caller, and must stay in place
  /// and unchanged while this table or a copy is used. `owner`, if given, is
  /// kept as long as the column is.
  void Borrow(const std::string& column, const Numbers& numbers,
              std::shared_ptr<const void> owner = nullptr);

  struct Columns;
  const Columns& inside() const { return *columns_; }

 private:
  std::unique_ptr<Columns> columns_;
};

}  // namespace finray::v1

#endif  // FINRAY_TABLE_H_

#include <algorithm>
#include <utility>

#include "finray/io/frame_vocabulary.h"
#include "inside.h"

namespace finray::v1 {

struct Table::Columns {
  struct Column {
    std::string name;
    Numbers numbers;                    ///< Without values: the column is text.
    std::shared_ptr<const void> owner;  ///< Of the numbers.
    std::shared_ptr<const std::vector<std::string>> text;
  };

  std::size_t rows = 0;
  std::string name;
  std::vector<Column> all;

  const Column* Find(const std::string& column) const {
    const auto found =
        std::find_if(all.begin(), all.end(),
                     [&](const Column& c) { return c.name == column; });
    return found == all.end() ? nullptr : &*found;
  }
  const Column& At(const std::string& column, bool is_text) const {
    const Column* found = Find(column);
    if (found == nullptr) {
      std::vector<std::string> names;
      for (const Column& c : all) names.push_back(c.name);
      throw InputError(name + ": " + NoColumn(column, names));
    }
    if ((found->text != nullptr) != is_text) {
      throw InputError(name + ": column '" + column + "' holds " +
                       (is_text ? "numbers" : "text"));
    }
    return *found;
  }
  void Put(Column column, std::size_t size) {
    if (size != rows) {
      throw InputError(name + ": column '" + column.name + "': expected " +
                       std::to_string(rows) + " values, found " +
                       std::to_string(size));
    }
    if (column.text != nullptr && IsFrameColumn(column.name)) {
      throw InputError(name + ": column '" + column.name +
                       "' of the frame table holds numbers, found text");
    }
    for (Column& old : all) {
      if (old.name != column.name) continue;
      old = std::move(column);
      return;
    }
    all.push_back(std::move(column));
  }
};

Table::Table(std::size_t rows, const std::string& name)
    : columns_(new Columns{rows, name, {}}) {}
Table::~Table() = default;
Table::Table(const Table& other) : columns_(new Columns(*other.columns_)) {}
Table& Table::operator=(const Table& other) {
  if (this != &other) columns_ = std::make_unique<Columns>(*other.columns_);
  return *this;
}
// A table that was moved from can still be used.
Table::Table(Table&& other) noexcept : columns_(new Columns()) {
  columns_.swap(other.columns_);
}
Table& Table::operator=(Table&& other) noexcept {
  columns_.swap(other.columns_);
  return *this;
}

Table Table::Read(const std::string& path) {
  return Guarded([&] { return FromFrameTable(FrameTable::Read(path), path); });
}

Table Table::Read(const std::string& path, const Scene& scene) {
  return Guarded([&] {
    return FromFrameTable(FrameTable::Read(path, scene.inside().scene.columns),
                          path);
  });
}

void Table::Write(const std::string& path) const {
  Guarded([&] { ToFrameTable(*this).Write(path); });
}

std::string Table::ToCsv() const {
  return Guarded([&] { return ToFrameTable(*this).ToCsv(); });
}

const std::string& Table::name() const { return columns_->name; }
std::size_t Table::rows() const { return columns_->rows; }

std::vector<std::string> Table::columns() const {
  std::vector<std::string> names;
  for (const Columns::Column& column : columns_->all) {
    names.push_back(column.name);
  }
  return names;
}

bool Table::Has(const std::string& column) const {
  return columns_->Find(column) != nullptr;
}

bool Table::IsText(const std::string& column) const {
  const Columns::Column* found = columns_->Find(column);
  return found != nullptr && found->text != nullptr;
}

Numbers Table::At(const std::string& column) const {
  return columns_->At(column, false).numbers;
}

const std::vector<std::string>& Table::TextAt(const std::string& column) const {
  return *columns_->At(column, true).text;
}

void Table::Set(const std::string& column, std::vector<double> values) {
  const auto owner = std::make_shared<std::vector<double>>(std::move(values));
  Borrow(column, {owner->data(), owner->size(), 1}, owner);
}

void Table::SetText(const std::string& column, std::vector<std::string> texts) {
  auto text = std::make_shared<std::vector<std::string>>(std::move(texts));
  const std::size_t size = text->size();
  columns_->Put({column, {}, nullptr, std::move(text)}, size);
}

void Table::Borrow(const std::string& column, const Numbers& numbers,
                   std::shared_ptr<const void> owner) {
  columns_->Put({column, numbers, std::move(owner), nullptr}, numbers.size);
}

FrameTable ToFrameTable(const Table& table) {
  FrameTable copy(table.rows(), table.name());
  for (const std::string& name : table.columns()) {
    if (table.IsText(name)) {
      copy.MutableText(name) = table.TextAt(name);
      continue;
    }
    const Numbers numbers = table.At(name);
    std::vector<double>& values = copy.MutableNumbers(name);
    for (std::size_t i = 0; i < numbers.size; ++i) values[i] = numbers[i];
  }
  return copy;
}

Table FromFrameTable(const FrameTable& table, const std::string& name) {
  Table copy(table.rows(), name);
  for (const std::string& column : table.headers()) {
    if (table.IsText(column)) {
      copy.SetText(column, table.Text(column));
    } else {
      copy.Set(column, table.Numbers(column));
    }
  }
  return copy;
}

}  // namespace finray::v1

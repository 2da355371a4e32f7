#include "finray/io/frame_reader.h"

#include "finray/io/error.h"

namespace finray {
FrameReader::FrameReader(const std::string& path, const ColumnMapping& mapping)
    : lines_(ReadFile(path), path, mapping) {
  lines_.FindDecimal();
  looked_ahead_ = lines_.Next();
  if (!looked_ahead_) {
    throw InputError(path + ": is an empty log: it has a header but no rows");
  }
}

bool FrameReader::NextRow() {
  if (!looked_ahead_ && !lines_.Next()) return false;
  looked_ahead_ = false;
  ++position_;
  return true;
}

bool FrameReader::ReadLines(std::size_t rows, LineBlock* block) {
  block->Clear();
  try {
    while (block->size() < rows && NextRow()) block->Add(lines_.line());
  } catch (const InputError& error) {
    block->error = error.what();
  }
  return block->size() > 0 || !block->error.empty();
}

std::size_t FrameReader::Skip(std::size_t rows) {
  std::size_t skipped = 0;
  while (skipped < rows && NextRow()) ++skipped;
  return skipped;
}

FrameTable FrameTable::Read(const std::string& path,
                            const ColumnMapping& mapping) {
  FrameReader reader(path, mapping);
  const FrameParser& parser = reader.parser();
  FrameTable table;
  table.path_ = path;
  for (std::size_t i = 0; i < parser.names().size(); ++i) {
    Column& column = table.columns_.emplace_back();
    column.name = parser.names()[i];
    if (!parser.IsNumeric(i)) column.cells = std::vector<std::string>();
  }
  FrameRows row;
  while (reader.NextRow()) {
    row.Clear();
    parser.Parse(reader.lines_.line(), &row);
    for (std::size_t i = 0; i < table.columns_.size(); ++i) {
      auto& cells = table.columns_[i].cells;
      if (auto* numbers = std::get_if<std::vector<double>>(&cells)) {
        numbers->push_back(row.at(0, i).number);
      } else {
        std::get<std::vector<std::string>>(cells).emplace_back(
            row.at(0, i).text);
      }
    }
    table.lines_.push_back(reader.lines_.line().number);
    ++table.rows_;
  }
  return table;
}

}  // namespace finray

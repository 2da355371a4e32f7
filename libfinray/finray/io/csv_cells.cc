#include "finray/io/csv_cells.h"

namespace finray {
namespace {

// Takes a quoted cell off the front of `line` (behind its first quote) and
// undoubles its quotes. False if the closing quote is missing.
bool TakeQuoted(std::string_view* line, std::string* cell) {
  for (;;) {
    const auto quote = line->find('"');
    if (quote == std::string_view::npos) return false;
    cell->append(line->substr(0, quote));
    line->remove_prefix(quote + 1);
    if (line->empty() || line->front() != '"') return true;
    *cell += '"';
    line->remove_prefix(1);
  }
}

}  // namespace

std::string_view Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string CsvCells::Split(std::string_view line) {
  cells_.clear();
  unquoted_.clear();
  for (;;) {
    const auto start = line.find_first_not_of(" \t");
    const bool quoted = start != std::string_view::npos && line[start] == '"';
    if (quoted) {
      line.remove_prefix(start + 1);
      const bool closed = TakeQuoted(&line, &unquoted_.emplace_back());
      cells_.push_back(unquoted_.back());
      if (!closed) return "a quoted cell does not end on its line";
    }
    const auto comma = line.find(',');
    const std::string_view rest = Trimmed(line.substr(0, comma));
    if (!quoted) {
      cells_.push_back(rest);
    } else if (!rest.empty()) {
      return "text behind the closing quote of a cell";
    }
    if (comma == std::string_view::npos) return "";
    line.remove_prefix(comma + 1);
  }
}

std::string CsvText(const std::string& cell) {
  const bool comment = !cell.empty() && cell.front() == '#';
  if (cell.find_first_of(",\"\r\n") == std::string::npos &&
      Trimmed(cell) == cell && !comment) {
    return cell;
  }
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace finray

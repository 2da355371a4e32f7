#include "finray/io/csv_cells.h"

#include <algorithm>

#include "finray/io/number_text.h"

namespace finray {
namespace {

// Removes a quoted cell from the front of `line`. The first quote of the cell
// is already gone. Doubled quotes become single ones. Returns false if the
// closing quote is missing.
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

template <char kDelimiter>
std::string_view WithoutBlanks(std::string_view cell) {
  if constexpr (kDelimiter != '\t') return Trimmed(cell);
  while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
  while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
  return cell;
}

template <char kDelimiter>
const char* SplitAt(std::string_view line, std::vector<std::string_view>* cells,
                    std::deque<std::string>* unquoted) {
  constexpr const char* kBlank = kDelimiter == '\t' ? " " : " \t";
  cells->clear();
  for (;;) {
    const auto start = line.find_first_not_of(kBlank);
    const bool quoted = start != std::string_view::npos && line[start] == '"';
    if (quoted) {
      line.remove_prefix(start + 1);
      const bool closed = TakeQuoted(&line, &unquoted->emplace_back());
      cells->push_back(unquoted->back());
      if (!closed) return "a quoted cell does not end on its line";
    }
    const auto end = line.find(kDelimiter);
    const std::string_view rest =
        WithoutBlanks<kDelimiter>(line.substr(0, end));
    if (!quoted) {
      cells->push_back(rest);
    } else if (!rest.empty()) {
      return "text behind the closing quote of a cell";
    }
    if (end == std::string_view::npos) return "";
    line.remove_prefix(end + 1);
  }
}

}  // namespace

const char* SplitCsvLine(std::string_view line, char delimiter,
                         std::vector<std::string_view>* cells,
                         std::deque<std::string>* unquoted) {
  if (delimiter == ';') return SplitAt<';'>(line, cells, unquoted);
  if (delimiter == '\t') return SplitAt<'\t'>(line, cells, unquoted);
  return SplitAt<','>(line, cells, unquoted);
}

std::optional<double> NumberInCell(std::string_view cell, char decimal) {
  if (decimal == '.') return ParseNumber(cell);
  if (cell.find('.') != cell.npos) return std::nullopt;
  std::string text(cell);
  std::replace(text.begin(), text.end(), ',', '.');
  return ParseNumber(text);
}

void AppendCsvText(std::string_view cell, std::string* csv) {
  const bool comment = !cell.empty() && cell.front() == '#';
  // A header with another delimiter could be cut there.
  if (cell.find_first_of(",;\t\"\r\n") == std::string::npos &&
      Trimmed(cell) == cell && !comment) {
    csv->append(cell);
    return;
  }
  *csv += '"';
  for (const char c : cell) {
    if (c == '"') *csv += '"';
    *csv += c;
  }
  *csv += '"';
}

}  // namespace finray

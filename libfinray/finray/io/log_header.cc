#include "finray/io/log_header.h"

#include <algorithm>
#include <deque>
#include <set>
#include <vector>

#include "finray/io/csv_cells.h"
#include "finray/io/frame_vocabulary.h"

namespace finray {
namespace {

constexpr std::string_view kDelimiters = ",;\t";

KnownNames NamesCutBy(char delimiter, std::string_view header,
                      const ColumnMapping& mapping) {
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  const std::string_view error =
      SplitCsvLine(header, delimiter, &cells, &unquoted);
  if (!error.empty()) return {};
  KnownNames names;
  std::set<std::string_view> wanted;
  for (const ColumnRule& rule : mapping.rules) wanted.insert(rule.from);
  for (const std::string_view cell : cells) {
    names.count += wanted.erase(cell) > 0 || IsFrameColumn(cell);
  }
  names.suffice = names.count > 0 && wanted.empty();
  return names;
}

// Returns the delimiters that stand outside quotes.
std::string DelimitersIn(std::string_view header) {
  std::string found;
  bool quoted = false;
  for (const char c : header) {
    if (c == '"') quoted = !quoted;
    if (!quoted && kDelimiters.find(c) != kDelimiters.npos &&
        found.find(c) == found.npos) {
      found += c;
    }
  }
  return found;
}

}  // namespace

bool MayBeHeader(CsvLine* line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  while (line->text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    line->text.remove_prefix(kByteOrderMark.size());
  }
  const std::string_view text = Trimmed(line->text);
  return !text.empty() && text.front() != '#';
}

KnownNames FindKnownNames(std::string_view header,
                          const ColumnMapping& mapping) {
  const std::string delimiters = mapping.delimiter
                                     ? std::string(1, *mapping.delimiter)
                                     : DelimitersIn(header) + kDelimiters[0];
  KnownNames most;
  for (const char delimiter : delimiters) {
    const KnownNames names = NamesCutBy(delimiter, header, mapping);
    if (names.count > most.count) most = names;
  }
  return most;
}

char DelimiterOf(std::string_view header, const ColumnMapping& mapping) {
  if (mapping.delimiter) return *mapping.delimiter;
  const std::string found = DelimitersIn(header);
  if (found.empty()) return kDelimiters[0];
  if (found.size() == 1) return found[0];
  char only = '\0';
  for (const char delimiter : found) {
    if (NamesCutBy(delimiter, header, mapping).count == 0) continue;
    if (only != '\0') return '\0';
    only = delimiter;
  }
  return only;
}

std::string UnitInBrackets(std::string_view header) {
  if (header.size() < 3) return "";
  const char close = header.back();
  if (close != ']' && close != ')') return "";
  const std::size_t open = header.rfind(close == ']' ? '[' : '(');
  if (open == header.npos) return "";
  // "sensor(s)" names no unit.
  if (close == ')' && (open == 0 || header[open - 1] != ' ')) return "";
  const auto unit = FindUnitInFile(
      Trimmed(header.substr(open + 1, header.size() - open - 2)));
  return unit ? unit->name : "";
}

}  // namespace finray

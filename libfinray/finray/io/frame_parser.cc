#include "finray/io/frame_parser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Renames refer to the names in the file, so that two columns can be swapped.
std::vector<std::string> Renamed(
    const std::string& path, const std::vector<std::string>& found,
    const std::map<std::string, std::string>& renames) {
  std::vector<std::string> headers = found;
  for (const auto& [key, value] : renames) {
    // The entry is {lab's header: our name}, or the other way round.
    const bool reversed = IsFrameColumn(key) && !IsFrameColumn(value);
    const std::string& from = reversed ? value : key;
    const std::string& to = reversed ? key : value;
    if (!IsFrameColumn(to) && to != "status") {
      throw InputError(path + ": column " + ShownText(from) +
                       " is renamed to " + ShownText(to) +
                       ", which is no known column" +
                       DidYouMeanFrameColumn(to));
    }
    const auto at = std::find(found.begin(), found.end(), from);
    if (at == found.end()) {
      throw InputError(path + ": no column " + ShownText(from) +
                       " to rename to " + ShownText(to) +
                       DidYouMean(from, found));
    }
    headers[static_cast<std::size_t>(at - found.begin())] = to;
  }
  return headers;
}

bool IsNan(std::string_view text) {
  // printf writes a NaN with its sign.
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    text.remove_prefix(1);
  }
  return text.size() == 3 && (text[0] | 0x20) == 'n' &&
         (text[1] | 0x20) == 'a' && (text[2] | 0x20) == 'n';
}

// Returns the number in a cell, NaN for an empty cell or "nan".
std::optional<double> CellNumber(std::string_view text) {
  if (text.empty() || IsNan(text)) return kNaN;
  return ParseNumber(text);
}

// Says whether a character is a control character other than a tab.
bool IsControl(char c) {
  return c != '\t' && (static_cast<unsigned char>(c) < 0x20 || c == '\x7f');
}

// Returns the index of the first cell of a line that holds a NUL byte, or the
// number of cells if there is none.
std::size_t FirstNul(const CsvLine& line,
                     const std::vector<std::string_view>& cells) {
  if (!line.nul) return cells.size();
  const auto at =
      std::find_if(cells.begin(), cells.end(), [](std::string_view cell) {
        return cell.find('\0') != std::string_view::npos;
      });
  return static_cast<std::size_t>(at - cells.begin());
}

}  // namespace

bool IsHeaderLine(CsvLine* line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  while (line->text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    line->text.remove_prefix(kByteOrderMark.size());
  }
  line->text = Trimmed(line->text);
  return !line->text.empty() && line->text.front() != '#';
}

FrameParser::FrameParser(const std::string& path, const CsvLine& header,
                         const std::map<std::string, std::string>& renames)
    : path_(path) {
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  const std::string error = SplitCsvLine(header.text, &cells, &unquoted);
  if (!error.empty()) FailAt(header.number, cells.size() - 1, error);
  const std::size_t nul = FirstNul(header, cells);
  if (nul < cells.size()) {
    FailAt(header.number, nul,
           "the header holds a NUL byte, expected UTF-8 text");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // Names hold no control characters, but unrecognised zip files do.
    const auto bad = std::find_if(cells[i].begin(), cells[i].end(), IsControl);
    if (bad == cells[i].end()) continue;
    FailAt(header.number, i,
           "the header " + ShownText(cells[i]) +
               (*bad == '\r' ? " holds a carriage return, expected lines that "
                               "end with a line feed"
                             : " holds a control character, expected text"));
  }
  if (cells.size() == 1 && cells[0].find_first_of(";\t") != cells[0].npos) {
    Fail(header.number, "no commas in the header " + ShownText(cells[0]) +
                            ", expected cells with commas between them");
  }
  names_ = Renamed(path, {cells.begin(), cells.end()}, renames);
  if (std::all_of(names_.begin(), names_.end(), ParseNumber)) {
    Fail(header.number, "expected a header, found numbers only");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!seen.insert(names_[i]).second) {
      FailAt(header.number, i,
             "header " + ShownText(names_[i]) + " appears twice");
    }
    numeric_.push_back(IsFrameColumn(names_[i]));
  }
}

void FrameParser::Parse(const CsvLine& line, FrameRows* rows) const {
  std::vector<std::string_view>& split = rows->split_;
  FrameRows::Cell* cells = rows->AddRow(names_.size());
  const char* error = SplitCsvLine(line.text, &split, &rows->unquoted_);
  if (*error != '\0') FailAt(line.number, split.size() - 1, error);
  if (split.size() != names_.size()) {
    Fail(line.number, "expected " + std::to_string(names_.size()) +
                          " cells as in the header, found " +
                          std::to_string(split.size()));
  }
  const std::size_t nul = FirstNul(line, split);
  if (nul < split.size()) {
    FailAt(
        line.number, nul,
        ShownLine(names_[nul]) + ": the cell holds a NUL byte, expected text");
  }
  for (std::size_t i = 0; i < split.size(); ++i) {
    if (!numeric_[i]) {
      cells[i].text = split[i];
      continue;
    }
    const std::string_view text = Trimmed(split[i]);  // quotes keep spaces
    std::optional<double> number = CellNumber(text);
    // A cylinder of infinite radius is a plane.
    if (!number && text == "inf" && names_[i] == "cylinder_radius_mm") {
      number = std::numeric_limits<double>::infinity();
    }
    if (!number) {
      FailAt(line.number, i,
             names_[i] + ": expected a number, found " + ShownText(split[i]));
    }
    cells[i] = {*number, text};
  }
}

void FrameParser::Fail(int line, const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line) + ": " + message);
}

void FrameParser::FailAt(int line, std::size_t cell,
                         const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line) + ":" +
                   std::to_string(cell + 1) + ": " + message);
}

}  // namespace finray

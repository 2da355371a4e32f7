#include "finray/io/units.h"

#include <functional>
#include <map>

namespace finray {
namespace {

// The same list is that of finray_import.
const std::vector<Unit>& AllUnits() {
#define FINRAY_UNIT(name, dimension, multiply, divide, shift) \
  {#name, Dimension::dimension, multiply, divide, shift},
#define FINRAY_FILE_WORD(word, name)
  static const std::vector<Unit> units = {
#include "../../../scripts/import/units.inc"
  };
#undef FINRAY_UNIT
#undef FINRAY_FILE_WORD
  return units;
}

const std::map<std::string, std::string, std::less<>>& FileWords() {
#define FINRAY_UNIT(name, dimension, multiply, divide, shift)
#define FINRAY_FILE_WORD(word, name) {#word, #name},
  static const std::map<std::string, std::string, std::less<>> words = {
#include "../../../scripts/import/units.inc"
  };
#undef FINRAY_UNIT
#undef FINRAY_FILE_WORD
  return words;
}

void Replace(std::string_view from, std::string_view to, std::string* text) {
  for (auto at = text->find(from); at != std::string::npos;
       at = text->find(from, at + to.size())) {
    text->replace(at, from.size(), to);
  }
}

}  // namespace

std::optional<Unit> FindUnit(std::string_view name) {
  std::string plain(name);
  Replace("\xC2\xB5", "u", &plain);    // the micro sign
  Replace("\xCE\xBC", "u", &plain);    // the Greek letter
  Replace("\xC2\xB0", "deg", &plain);  // the degree sign
  if (plain.size() > 2 && plain.front() == 'N' && plain.back() == 'm') {
    for (const char* between :
         {" ", ".", "*", "-", "\xC2\xB7", "\xE2\x8B\x85"}) {
      Replace(between, "", &plain);  // N mm
    }
  }
  for (const Unit& unit : AllUnits()) {
    if (unit.name == plain) return unit;
  }
  return std::nullopt;
}

std::optional<Unit> FindUnitInFile(std::string_view word) {
  const auto found = FileWords().find(word);
  return FindUnit(found == FileWords().end() ? word : found->second);
}

Unit UnitOfColumn(const std::string& column) {
  return FindUnitInFile(column.substr(column.rfind('_') + 1)).value_or(Unit());
}

std::vector<std::string> UnitNames(Dimension dimension) {
  std::vector<std::string> names;
  for (const Unit& unit : AllUnits()) {
    if (unit.dimension == dimension) names.push_back(unit.name);
  }
  return names;
}

}  // namespace finray

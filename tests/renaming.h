#ifndef FINRAY_TESTS_RENAMING_H_
#define FINRAY_TESTS_RENAMING_H_

#include <string>

#include "finray/io/column_mapping.h"

namespace finray {

/// A mapping of one column, which stays as it is.
inline ColumnMapping Renaming(const std::string& from, const std::string& to) {
  ColumnMapping mapping;
  mapping.rules.emplace_back();
  mapping.rules[0].from = from;
  mapping.rules[0].to = to;
  return mapping;
}

}  // namespace finray

#endif  // FINRAY_TESTS_RENAMING_H_

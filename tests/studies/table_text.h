#ifndef FINRAY_TESTS_STUDIES_TABLE_TEXT_H_
#define FINRAY_TESTS_STUDIES_TABLE_TEXT_H_

#include <cstdio>
#include <string>

namespace finray {

/// A number as in a table's first column.
inline std::string ShortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_TABLE_TEXT_H_

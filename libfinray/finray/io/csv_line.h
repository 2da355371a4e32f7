#ifndef FINRAY_IO_CSV_LINE_H_
#define FINRAY_IO_CSV_LINE_H_

#include <string_view>

namespace finray {

/// A line of a CSV file, without its end.
struct CsvLine {
  std::string_view text;
  int number = 0;  ///< In the file, from 1.
  /// Whether it may hold a NUL byte, as such or as kNulStandIn.
  bool nul = false;
};

/// What stands for NUL where NUL would end the text.
constexpr char kNulStandIn = '\x01';

}  // namespace finray

#endif  // FINRAY_IO_CSV_LINE_H_

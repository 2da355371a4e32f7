#ifndef FINRAY_IO_LOG_HEADER_H_
#define FINRAY_IO_LOG_HEADER_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "finray/io/column_mapping.h"
#include "finray/io/line_reader.h"

namespace finray {

/// Removes byte order marks from the front of a line and says whether it may be
/// a header: it is no '#' comment and not blank. Files that were put together
/// from others have such marks behind comments too.
bool MayBeHeader(CsvLine* line);

/// How many of a line's cells name a column: of the vocabulary, or one that the
/// mapping takes.
struct KnownNames {
  std::size_t count = 0;
  /// All columns of the mapping are there, or any name without a mapping.
  bool suffice = false;
};
KnownNames FindKnownNames(std::string_view header,
                          const ColumnMapping& mapping);

/// Returns the delimiter that the mapping states, or the one of , ; and tab
/// that the header holds outside quotes: a comma if none. If it holds several,
/// it is the only one that cuts out a known name. Returns '\0' if that does not
/// decide.
char DelimiterOf(std::string_view header, const ColumnMapping& mapping);

/// Returns the unit in brackets at the end of a header, "N" for "Fz [N]" and
/// "Fz (N)", or "" if there is none that FindUnit knows.
std::string UnitInBrackets(std::string_view header);

}  // namespace finray

#endif  // FINRAY_IO_LOG_HEADER_H_

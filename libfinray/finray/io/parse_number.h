#ifndef FINRAY_IO_PARSE_NUMBER_H_
#define FINRAY_IO_PARSE_NUMBER_H_

#include <optional>
#include <string_view>

namespace finray {

/// The finite decimal number that `text` is as a whole ("12", "+1.5", "-2e-3"),
/// or nothing. The decimal sign is a point, whatever the locale.
std::optional<double> ParseNumber(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_PARSE_NUMBER_H_

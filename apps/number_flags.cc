#include "number_flags.h"

#include <cmath>

#include "app.h"
#include "finray/io/number_text.h"

namespace finray {

double PositiveFlag(const char* flag, double value) {
  if (!(value > 0) || std::isinf(value)) {
    throw UsageError(std::string("--") + flag +
                     ": expected a number above 0, found " + NumberText(value));
  }
  return value;
}

std::pair<double, double> RangeFlag(const char* flag, const std::string& text) {
  const std::size_t colon = text.find(':');
  std::optional<double> from, to;
  if (colon != std::string::npos) {
    from = ParseNumber(text.substr(0, colon));
    to = ParseNumber(text.substr(colon + 1));
  }
  if (!from || !to || !(*to > *from)) {
    throw UsageError(std::string("--") + flag +
                     ": expected from:to in mm, such as 20:105, found " + text);
  }
  return {*from, *to};
}

std::pair<double, double> RegionFlag(const char* flag, const std::string& text,
                                     const Finger& finger, double from_share,
                                     double to_share) {
  const double length = finger.front_length_mm;
  if (text.empty()) return {from_share * length, to_share * length};
  const auto region = RangeFlag(flag, text);
  if (!(region.first > 0 && region.second < length)) {
    throw UsageError(
        FormatText("--%s: expected a part of the front beam, 0 to %g mm, "
                   "found %s",
                   flag, length, text.c_str()));
  }
  return region;
}

}  // namespace finray

#ifndef FINRAY_APPS_NUMBER_FLAGS_H_
#define FINRAY_APPS_NUMBER_FLAGS_H_

#include <string>
#include <utility>

#include "finray/finger/finger.h"

namespace finray {

// Checks of flags. Each throws UsageError with the flag's name, what it expects
// and what it found.

/// A number above 0.
double PositiveFlag(const char* flag, double value);

/// Both numbers of "from:to", from < to.
std::pair<double, double> RangeFlag(const char* flag, const std::string& text);

/// "from:to" within the front beam of the finger; if the flag is empty, these
/// shares of it.
std::pair<double, double> RegionFlag(const char* flag, const std::string& text,
                                     const Finger& finger, double from_share,
                                     double to_share);

}  // namespace finray

#endif  // FINRAY_APPS_NUMBER_FLAGS_H_

#ifndef FINRAY_IO_ISO_TIME_H_
#define FINRAY_IO_ISO_TIME_H_

#include <optional>
#include <string_view>

namespace finray {

/// Returns the seconds from 1970-01-01T00:00:00Z to a time of ISO 8601,
/// "2026-11-24T10:30:15.250+01:00", or nothing if `text` is none. A space may
/// stand for the T and a comma for the point. Seconds with their fraction, and
/// the zone (Z, +hh, +hhmm, +hh:mm), may be missing; a time without a zone is
/// taken as UTC. Today's seconds as a double are exact to 0.2 us.
std::optional<double> IsoTime(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_ISO_TIME_H_

#ifndef FINRAY_IO_NAN_H_
#define FINRAY_IO_NAN_H_

#include <limits>

namespace finray {

/// A value that was not measured or is unknown.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace finray

#endif  // FINRAY_IO_NAN_H_

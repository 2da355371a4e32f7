#ifndef FINRAY_IO_NUMBER_TEXT_H_
#define FINRAY_IO_NUMBER_TEXT_H_

#include <string>

namespace finray {

// Numbers with a decimal point, whatever locale a host program has taken on.

/// The shortest text that reads back as the same double; "nan", "inf" or
/// "-inf" for what is not finite.
std::string NumberText(double value);

/// As std::snprintf, of any length.
std::string FormatText(const char* format, ...)
    __attribute__((format(printf, 1, 2)));

}  // namespace finray

#endif  // FINRAY_IO_NUMBER_TEXT_H_

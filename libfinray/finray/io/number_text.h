#ifndef FINRAY_IO_NUMBER_TEXT_H_
#define FINRAY_IO_NUMBER_TEXT_H_

#include <locale.h>  // uselocale is not in <clocale>

#include <string>

namespace finray {

// Numbers with a decimal point, whatever locale a host program has taken on.

/// The shortest text that reads back as the same double; "nan", "inf" or
/// "-inf" for what is not finite.
std::string NumberText(double value);

/// As std::snprintf, of any length.
std::string FormatText(const char* format, ...)
    __attribute__((format(printf, 1, 2)));

/// While it lives std::snprintf of this thread has the C locale: for libraries
/// that write numbers into their messages.
class ClassicNumbers {
 public:
  ClassicNumbers();
  ~ClassicNumbers() { uselocale(before_); }
  ClassicNumbers(const ClassicNumbers&) = delete;
  ClassicNumbers& operator=(const ClassicNumbers&) = delete;

 private:
  locale_t before_;
};

}  // namespace finray

#endif  // FINRAY_IO_NUMBER_TEXT_H_

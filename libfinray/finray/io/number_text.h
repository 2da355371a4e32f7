#ifndef FINRAY_IO_NUMBER_TEXT_H_
#define FINRAY_IO_NUMBER_TEXT_H_

#include <locale.h>  // uselocale is not in <clocale>

#include <optional>
#include <string>
#include <string_view>

namespace finray {

// Numbers as text and back, with a decimal point in every locale.

/// Returns the finite decimal number that the whole of `text` stands for ("12",
/// "+1.5", "-2e-3"), or nothing.
std::optional<double> ParseNumber(std::string_view text);

/// Returns the shortest text that reads back as the same double, or "nan",
/// "inf" or "-inf".
std::string NumberText(double value);

/// Returns a number in YAML that reads back as the same double: .nan, .inf, and
/// a point before an exponent, without which YAML 1.1 reads text. With `digits`
/// the number is rounded to that many (0.1 + 0.2 is 0.3 with 12).
std::string YamlNumber(double value, int digits = 0);

/// Formats like std::snprintf, but returns a string of any length.
std::string FormatText(const char* format, ...)
    __attribute__((format(printf, 1, 2)));

/// While it lives, std::snprintf of this thread uses the C locale. Libraries
/// that write numbers into messages need it.
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

#ifndef FINRAY_IO_UTF8_H_
#define FINRAY_IO_UTF8_H_

#include <string>
#include <string_view>

namespace finray {

/// Returns the number of bytes of the UTF-8 character at the front of a text
/// that is not empty; 0 if there is none.
std::size_t Utf8Bytes(std::string_view text);

/// Returns a text for files in UTF-8, such as YAML. A name of a file may hold
/// any bytes: if some are not UTF-8, or characters that readers of YAML refuse
/// or take for line ends, these stand as %XX, and so does each % then. Other
/// texts stay as they are.
std::string AsUtf8(std::string_view bytes);

/// Returns the text with the bytes that AsUtf8 has written as %XX.
std::string WithoutPercents(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_UTF8_H_

#ifndef FINRAY_IO_SHA256_H_
#define FINRAY_IO_SHA256_H_

#include <functional>
#include <string>

namespace finray {

/// Returns the SHA-256 of a file's bytes in hexadecimal. Throws InputError if
/// the file cannot be read. Ends early with an empty text once `stop` says so.
std::string Sha256OfFile(const std::string& path,
                         const std::function<bool()>& stop = {});

/// Returns the SHA-256 of a text's bytes in hexadecimal.
std::string Sha256OfText(const std::string& text);

}  // namespace finray

#endif  // FINRAY_IO_SHA256_H_

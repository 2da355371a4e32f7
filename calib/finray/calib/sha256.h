#ifndef FINRAY_CALIB_SHA256_H_
#define FINRAY_CALIB_SHA256_H_

#include <string>

namespace finray {

/// SHA-256 of a file's bytes in hexadecimal. InputError if it cannot be read.
std::string Sha256OfFile(const std::string& path);

}  // namespace finray

#endif  // FINRAY_CALIB_SHA256_H_

#ifndef FINRAY_VERSION_H_
#define FINRAY_VERSION_H_

#include <string>

#include "finray/export.h"

namespace finray::v1 {

/// The version of the library that runs, "1.2.3".
FINRAY_API std::string Version();

/// The library and those that it uses, one a line: "finray 1.2.3", "ceres
/// 2.1.0", ...
FINRAY_API std::string Versions();

/// The path of a file that finray comes with, by its name in the source tree:
/// "configs/fingers/paper_140mm.yaml". Throws InputError if it is not there.
FINRAY_API std::string ResourcePath(const std::string& name);

}  // namespace finray::v1

#endif  // FINRAY_VERSION_H_

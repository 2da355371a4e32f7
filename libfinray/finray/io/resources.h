#ifndef FINRAY_IO_RESOURCES_H_
#define FINRAY_IO_RESOURCES_H_

#include <string>

namespace finray {

/// Returns the path of a file that finray comes with: a script, a template, a
/// finger. `name` is its path in the source tree, "calib/report/render.py".
/// Files lie in the first of these folders that holds them, seen from the
/// folder of the executable or shared library with this code:
///
///   share/finray          a build tree (a link) and a Python package
///   ../share/finray       an executable in bin/
///   ../../share/finray    a library in lib/<triplet>/
///
/// No path of the build is compiled in, so an installation can be moved. Throws
/// InputError if no folder holds the file.
std::string ResourcePath(const std::string& name);

}  // namespace finray

#endif  // FINRAY_IO_RESOURCES_H_

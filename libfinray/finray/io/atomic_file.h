#ifndef FINRAY_IO_ATOMIC_FILE_H_
#define FINRAY_IO_ATOMIC_FILE_H_

#include <string>

namespace finray {

/// Writes the whole content under a temporary name in the same folder and
/// renames it, so that `path` never holds a partial file. The temporary file is
/// removed on failure. Links are followed; a device or pipe, which cannot be
/// replaced, is written to as it is. Throws InputError saying what failed.
void WriteFileAtomically(const std::string& path, const std::string& content);

/// Creates a folder and its parents; InputError naming it if that fails.
void MakeFolder(const std::string& path);

}  // namespace finray

#endif  // FINRAY_IO_ATOMIC_FILE_H_

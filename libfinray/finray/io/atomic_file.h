#ifndef FINRAY_IO_ATOMIC_FILE_H_
#define FINRAY_IO_ATOMIC_FILE_H_

#include <string>

namespace finray {

/// Writes the content under a temporary name in the same folder and renames the
/// file, so that `path` never holds a partial file. On failure it removes the
/// temporary file and throws InputError with the cause. Links are followed. A
/// device or pipe cannot be replaced and is written to directly.
void WriteFileAtomically(const std::string& path, const std::string& content);

/// Creates a folder and its parents. Throws InputError if that fails.
void MakeFolder(const std::string& path);

}  // namespace finray

#endif  // FINRAY_IO_ATOMIC_FILE_H_

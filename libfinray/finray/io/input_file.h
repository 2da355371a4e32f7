#ifndef FINRAY_IO_INPUT_FILE_H_
#define FINRAY_IO_INPUT_FILE_H_

#include <string>

namespace finray {

/// Throws InputError for a folder and for a pipe. A pipe could block for ever
/// and cannot be read twice. `expected` is the kind of file in the message ("a
/// YAML file"). It does not check whether the file can be opened.
void RefuseFolderOrPipe(const std::string& path, const std::string& expected);

/// Returns the bytes of a file. Throws InputError if it cannot be read, is a
/// folder or a pipe, or is longer than `most_MiB`.
std::string ReadWholeFile(const std::string& path, const std::string& expected,
                          int most_MiB);

}  // namespace finray

#endif  // FINRAY_IO_INPUT_FILE_H_

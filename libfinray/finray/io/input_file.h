#ifndef FINRAY_IO_INPUT_FILE_H_
#define FINRAY_IO_INPUT_FILE_H_

#include <string>

namespace finray {

/// Throws InputError for a folder and for a pipe, which would be waited for
/// without end and could not be read a second time. `expected` says of what
/// kind the file should be ("a YAML file"). Whether it can be opened shows when
/// it is.
void RefuseFolderOrPipe(const std::string& path, const std::string& expected);

}  // namespace finray

#endif  // FINRAY_IO_INPUT_FILE_H_

#ifndef FINRAY_IO_PYTHON_SCRIPT_H_
#define FINRAY_IO_PYTHON_SCRIPT_H_

#include <string>
#include <vector>

namespace finray {

/// Runs a Python script with Debian's interpreter, by its path, as the first on
/// PATH may lack matplotlib. Returns what went wrong, empty if nothing did;
/// `packages` is what the script needs, for the message.
std::string RunPythonScript(const std::string& script,
                            const std::vector<std::string>& arguments,
                            const std::string& packages);

}  // namespace finray

#endif  // FINRAY_IO_PYTHON_SCRIPT_H_

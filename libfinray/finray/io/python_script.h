#ifndef FINRAY_IO_PYTHON_SCRIPT_H_
#define FINRAY_IO_PYTHON_SCRIPT_H_

#include <string>
#include <vector>

namespace finray {

/// Runs a Python script that finray comes with, by its name in the source tree
/// (ResourcePath), with /usr/bin/python3: another interpreter on PATH may lack
/// matplotlib. Returns an error message, or "" on success. `packages` names the
/// script's packages for that message.
std::string RunPythonScript(const std::string& script,
                            const std::vector<std::string>& arguments,
                            const std::string& packages);

}  // namespace finray

#endif  // FINRAY_IO_PYTHON_SCRIPT_H_

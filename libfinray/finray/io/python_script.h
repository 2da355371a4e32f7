#ifndef FINRAY_IO_PYTHON_SCRIPT_H_
#define FINRAY_IO_PYTHON_SCRIPT_H_

#include <string>
#include <vector>

namespace finray {

/// Runs a Python script that finray comes with, by its name in the source tree
/// (ResourcePath), with /usr/bin/python3: another interpreter on PATH may lack
/// matplotlib. Returns its exit code, or -1 if it did not run to its end. The
/// script itself says what went wrong. Throws InputError if it is missing.
int RunPython(const std::string& script,
              const std::vector<std::string>& arguments);

/// The same, but returns an error message, or "" on success. `packages` names
/// the script's packages for that message. Throws InputError with the line of a
/// script that cannot write its file (calib/report/whole_file.py).
std::string RunPythonScript(const std::string& script,
                            const std::vector<std::string>& arguments,
                            const std::string& packages);

}  // namespace finray

#endif  // FINRAY_IO_PYTHON_SCRIPT_H_

#ifndef FINRAY_APPS_OUTPUTS_H_
#define FINRAY_APPS_OUTPUTS_H_

#include <string>
#include <vector>

namespace finray {

/// Returns the path of a file in the folder of --out_dir, which the executable
/// defines.
std::string OutPath(const std::string& name);

/// Throws InputError if one of the outputs is a file that was read.
void RefuseToOverwrite(const std::vector<std::string>& inputs,
                       const std::vector<std::string>& outputs);

}  // namespace finray

#endif  // FINRAY_APPS_OUTPUTS_H_

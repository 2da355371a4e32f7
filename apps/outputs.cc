#include <filesystem>

#include "app.h"

DECLARE_string(out_dir);

namespace finray {

std::string OutPath(const std::string& name) {
  return (std::filesystem::path(FLAGS_out_dir) / name).string();
}

void RefuseToOverwrite(const std::vector<std::string>& inputs,
                       const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    for (const std::string& input : inputs) {
      std::error_code missing;
      if (std::filesystem::equivalent(input, output, missing)) {
        throw InputError(input +
                         ": is an input and would be written over; "
                         "choose another --out_dir");
      }
    }
  }
}

}  // namespace finray

#ifndef FINRAY_APPS_OUTPUTS_H_
#define FINRAY_APPS_OUTPUTS_H_

#include <filesystem>
#include <string>
#include <vector>

#include "finray/io/error.h"

namespace finray {

/// Throws InputError if a file to be written is one of those that were read.
inline void RefuseToOverwrite(const std::vector<std::string>& inputs,
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

#endif  // FINRAY_APPS_OUTPUTS_H_

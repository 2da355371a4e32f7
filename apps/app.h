#ifndef FINRAY_APPS_APP_H_
#define FINRAY_APPS_APP_H_

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <exception>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/error.h"
#include "finray/scene/scene.h"

namespace finray {

/// Exit codes of all executables.
enum ExitCode {
  kGood = 0,
  kUsage = 1,
  kBadInput = 2,
  kSolveFailed = 3,
  kGateFailed = 4,
  kInterrupted = 130,
};

/// A flag that the user must give, for exit code 1.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline const std::string& Required(const char* flag, const std::string& value) {
  if (value.empty()) throw UsageError(std::string("--") + flag + " is missing");
  return value;
}

/// Comma-separated names.
inline std::vector<std::string> SplitList(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');) {
    if (!item.empty()) items.push_back(item);
  }
  return items;
}

/// What is in force after all files and defaults, as YAML, for --dump_config.
inline void DumpConfig(const Finger& finger, const Scene& scene,
                       const Discretization& discretization) {
  std::cout << "scheme: " << SchemeName(discretization.scheme) << "\n"
            << "resolution: " << EffectiveResolution(discretization) << "\n"
            << "contacts: "
            << (scene.contacts ? std::to_string(*scene.contacts) : "auto")
            << "\n";
  if (!scene.contact_beams.empty()) {
    std::cout << "contact_beams: " << ContactBeamsToYaml(scene) << "\n";
  }
  std::cout << "friction_coefficient: " << scene.friction_coefficient << "\n";
  if (scene.object) {
    std::cout << "object: " << ObjectToYaml(*scene.object) << "\n";
  }
  if (scene.object_std_mm) {
    std::cout << "measurements: {object_std_mm: " << *scene.object_std_mm
              << "}\n";
  }
  if (scene.smoothing) {
    std::cout << "smoothing: {contact_std_mm: " << scene.smoothing->contact_mm
              << ", normal_std_N: " << scene.smoothing->normal_N << "}\n";
  }
  std::istringstream lines(FingerToYaml(finger));
  std::cout << "finger:\n";
  for (std::string line; std::getline(lines, line);) {
    std::cout << "  " << line << "\n";
  }
}

/// Parses flags, runs, and turns what is thrown into one line and an exit code.
/// What is not a flag goes to `arguments`, or is an error without it.
inline int RunApp(int argc, char** argv, const std::string& usage,
                  const std::function<int()>& run,
                  std::vector<std::string>* arguments = nullptr) {
  gflags::SetUsageMessage(usage);
  gflags::SetVersionString(FINRAY_VERSION);
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  const std::string name = gflags::ProgramInvocationShortName();
  try {
    if (arguments != nullptr) {
      arguments->assign(argv + 1, argv + argc);
    } else if (argc > 1) {
      throw UsageError(std::string("'") + argv[1] +
                       "' is not a flag; flags start with --");
    }
    return run();
  } catch (const UsageError& error) {
    std::cerr << name << ": " << error.what() << "; see --help\n";
    return kUsage;
  } catch (const InputError& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return kSolveFailed;
  }
}

}  // namespace finray

#endif  // FINRAY_APPS_APP_H_

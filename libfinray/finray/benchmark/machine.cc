#include "finray/benchmark/machine.h"

#include <ceres/version.h>
#include <sched.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <fstream>

#include "finray/benchmark/build.h"
#include "finray/ladder/ladder_kernel.h"

namespace finray {
namespace {

std::string FirstLineOf(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string CpuModel() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0 || line.rfind("CPU part", 0) == 0) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string Caches() {
  std::string words;
  for (int i = 0; i < 8; ++i) {
    const std::string folder =
        "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    const std::string level = FirstLineOf(folder + "level");
    const std::string type = FirstLineOf(folder + "type");
    if (level.empty()) break;
    if (type == "Instruction") continue;
    words += (words.empty() ? "L" : ", L") + level +
             (type == "Data" ? "d " : " ") + FirstLineOf(folder + "size");
  }
  return words.empty() ? "unknown" : words;
}

}  // namespace

int UsableCores() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
}

Facts ThisMachine() {
  const std::string governor =
      FirstLineOf("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  utsname name;
  const bool named = uname(&name) == 0;
  return {{"cpu", CpuModel()},
          {"cores", std::to_string(UsableCores())},
          {"caches", Caches()},
          {"governor", governor.empty() ? "unknown" : governor},
          {"instruction_set", LadderInstructionSetName(0)},
          {"system", named ? std::string(name.sysname) + " " + name.release +
                                 " " + name.machine
                           : "unknown"}};
}

Facts ThisBuild() {
  return {{"version", FINRAY_VERSION},
          {"git", FINRAY_GIT},
          {"compiler", FINRAY_COMPILER},
          {"flags", FINRAY_FLAGS},
          {"ceres", CERES_VERSION_STRING},
          {"eigen", std::to_string(EIGEN_WORLD_VERSION) + "." +
                        std::to_string(EIGEN_MAJOR_VERSION) + "." +
                        std::to_string(EIGEN_MINOR_VERSION)}};
}

}  // namespace finray

#include "inside.h"

#include "finray/io/atomic_file.h"
#include "finray/io/resources.h"
#include "finray/io/versions.h"
#include "finray/io/yaml_limits.h"
#include "finray/version.h"

namespace finray::v1 {

Error::~Error() = default;
InputError::~InputError() = default;
SolveError::~SolveError() = default;
GateError::~GateError() = default;
Interrupted::~Interrupted() = default;

std::string Version() { return FINRAY_VERSION; }
std::string Versions() { return kVersions; }
std::string ResourcePath(const std::string& name) {
  return Guarded([&] { return finray::ResourcePath(name); });
}

const char* StatusName(FrameStatus status) {
  return finray::StatusName(static_cast<finray::FrameStatus>(status));
}

std::vector<Warning> ToPublic(const std::vector<finray::Warning>& warnings) {
  std::vector<Warning> all;
  for (const finray::Warning& warning : warnings) {
    all.push_back({warning.code, warning.text, warning.remedy});
  }
  return all;
}

finray::Discretization ToInternal(const Discretization& discretization) {
  return ParseDiscretization(discretization.scheme, discretization.resolution);
}

finray::FrameMethod MethodOf(const EstimateOptions& options) {
  const auto choose = [](const char* name, const std::string& word,
                         const char* a, const char* b) {
    if (word == a || word == b) return word == b;
    throw InputError(std::string(name) + ": expected " + a + " or " + b +
                     ", found '" + word + "'");
  };
  const bool ceres = choose("solver", options.solver, "fast", "ceres");
  const bool weighted =
      choose("equilibrium", options.equilibrium, "reduced", "weighted");
  if (weighted && !ceres) {
    throw InputError("equilibrium: weighted goes with solver ceres");
  }
  if (options.joint && ceres) {
    throw InputError("solver: does not go with joint, which uses Ceres");
  }
  return !ceres     ? FrameMethod::kFast
         : weighted ? FrameMethod::kCeresWeighted
                    : FrameMethod::kCeresReduced;
}

std::string YamlText(const std::string& path) {
  return ReadWholeFile(path, "a YAML file", kMostYaml_MiB);
}

finray::Scene SceneOf(const Scene& scene, bool in_order) {
  finray::Scene internal = scene.inside().scene;
  if (!in_order) internal.gauge_offset_walk.reset();
  return internal;
}

}  // namespace finray::v1

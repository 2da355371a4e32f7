// Calibrations of logs as a lab has them: how far every parameter is from the
// truth, in std and by itself, and whether outliers are found.
//   hard_logs_study [seeds]

#include <cstdio>
#include <cstdlib>

#include "calib/hard_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

struct Worst {
  double z = 0, stiffness_percent = 0, rib_mm = 0;
  int missed = 0, false_alarms = 0, outliers = 0;
  int bad = 0;  // calibrations that miss a bound
  double z2 = 0;
  int n = 0;
};

void Calibrate(const HardLogKind& kind, unsigned seed, Worst* worst) {
  const HardLog hard = MakeHardLog(kind, seed);
  const TempFolder folder;
  hard.log.Write(folder.Path("log.csv"));
  const Finger start = HardStart(hard);
  const Plan plan = HardPlan(kind);
  CalibrationProblem problem(
      start, plan, ReadCalibrationLogs({folder.Path("log.csv")}, start, plan),
      {}, 2);
  const CalibrationResult result = Calibrate(&problem);
  bool bad = !result.solution.solve.converged;
  const CalibrationParameters& parameters = problem.parameters();
  std::string where;
  for (std::size_t i = 0; i < parameters.free().size(); ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    if (!p.of_finger) continue;
    const double truth = ParameterValue(hard.truth, *p.of_finger);
    const double off = p.Value(*p.variable) - truth;
    const double std = p.ValueStd(*p.variable, result.identifiability.std[i]);
    const double z = std::abs(off) / std;
    worst->z = std::max(worst->z, z);
    worst->z2 += z * z;
    ++worst->n;
    if (z > 4) where += " " + p.name;
    bad |= z > 4;
    if (p.is_log) {
      const double percent = 100 * std::abs(off) / truth;
      worst->stiffness_percent = std::max(worst->stiffness_percent, percent);
      bad |= percent > 3;
    } else if (p.unit == "mm") {
      worst->rib_mm = std::max(worst->rib_mm, std::abs(off));
      bad |= std::abs(off) > 0.1;
    }
  }
  std::set<int> rejected;
  for (const auto& [frame, reason] : problem.rejected()) {
    rejected.insert(problem.logs().frames[frame].row);
  }
  for (const int row : hard.outliers) worst->missed += rejected.count(row) == 0;
  for (const int row : rejected) {
    worst->false_alarms += hard.outliers.count(row) == 0;
  }
  worst->outliers += static_cast<int>(hard.outliers.size());
  worst->bad += bad;
  if (bad) {
    std::printf("  %s seed %u: converged %d, cost %.4g%s\n", kind.name, seed,
                result.solution.solve.converged,
                result.solution.solve.final_cost, where.c_str());
  }
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  using namespace finray;
  const unsigned seeds = argc > 1 ? std::atoi(argv[1]) : 20;
  for (const HardLogKind& kind : kHardLogKinds) {
    Worst worst;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      Calibrate(kind, seed, &worst);
    }
    std::printf(
        "%s: %u logs, %d miss a bound; worst parameter %.2f std (rms %.2f), "
        "stiffness %.2f %%, rib %.3f mm; of %d outliers %d missed, %d false "
        "alarms\n",
        kind.name, seeds, worst.bad, worst.z, std::sqrt(worst.z2 / worst.n),
        worst.stiffness_percent, worst.rib_mm, worst.outliers, worst.missed,
        worst.false_alarms);
    std::fflush(stdout);
  }
  return 0;
}

// The standard log many times over: do the reported std say how far parameters
// are from the truth, and is that as near as the data allow?
//   calibration_coverage_study [seeds]

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "calib/standard_log.h"
#include "finray/calib/analysis/residual_correlation.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {
namespace {

struct Solved {
  std::vector<double> value, std;
  double chi2 = 0, dof = 0;
  std::size_t rejected = 0;
  bool converged = false;
};

Solved Solve(const FrameTable& log, std::vector<std::string>* names) {
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  const Plan plan = StandardPlan();
  CalibrationProblem problem(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("log.csv")}, Nominal(), plan), {}, 2);
  Solved solved;
  const CalibrationSolution solution = SolveRobustly(&problem);
  solved.converged = solution.solve.converged;
  Identifiability found = AnalyzeIdentifiability(&problem, solution.at);
  EnlargeStd(AnalyzeResidualCorrelation(problem.logs(), solution.at, found),
             &found);
  names->clear();
  for (std::size_t i = 0; i < found.std.size(); ++i) {
    const CalibrationParameters& parameters = problem.parameters();
    const CalibrationParameter& p = parameters.FreeParameter(i);
    names->push_back(p.name);
    solved.value.push_back(*p.variable);
    solved.std.push_back(found.std[i]);
  }
  for (const auto& noise : found.noise) {
    solved.chi2 += noise.chi2;
    solved.dof += noise.dof;
  }
  solved.rejected = problem.rejected().size();
  return solved;
}

int Main(unsigned seeds) {
  const Finger truth = HiddenFinger();
  const FrameTable frames = StandardFrames(truth, 1);
  std::vector<std::string> names;
  Finger noiseless = truth;
  for (Gauge& gauge : noiseless.gauges) gauge.noise_V = 0;
  // Without noise: the truth, and the bound for those frames.
  const Solved exact = Solve(MakeLog(noiseless, frames, {}), &names);
  const std::size_t n = names.size();
  std::vector<int> in_68(n), in_95(n);
  std::vector<double> sum(n), square(n);
  double chi2_per_dof = 0;
  std::size_t rejected = 0;
  int not_converged = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const Solved solved =
        Solve(MakeLog(truth, frames, {0.02, 0.05, seed}), &names);
    not_converged += !solved.converged;
    rejected += solved.rejected;
    chi2_per_dof += solved.chi2 / solved.dof / seeds;
    for (std::size_t i = 0; i < n; ++i) {
      const double off = solved.value[i] - exact.value[i];
      in_68[i] += std::abs(off) <= solved.std[i];
      in_95[i] += std::abs(off) <= 1.959964 * solved.std[i];
      sum[i] += off;
      square[i] += off * off;
    }
  }
  std::printf("%-26s %8s %8s %10s %12s\n", "parameter", "68 %", "95 %",
              "bias/std", "spread/bound");
  double all_68 = 0, all_95 = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double mean = sum[i] / seeds;
    const double spread = std::sqrt(square[i] / seeds - mean * mean);
    all_68 += 100.0 * in_68[i] / seeds / n;
    all_95 += 100.0 * in_95[i] / seeds / n;
    std::printf("%-26s %8.1f %8.1f %10.2f %12.3f\n", names[i].c_str(),
                100.0 * in_68[i] / seeds, 100.0 * in_95[i] / seeds,
                mean / exact.std[i], spread / exact.std[i]);
  }
  std::printf(
      "%u logs: coverage %.1f and %.1f %%, chi2/dof %.4f, %d not converged, "
      "%zu frames rejected\n",
      seeds, all_68, all_95, chi2_per_dof, not_converged, rejected);
  return 0;
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  return finray::Main(argc > 1 ? std::atoi(argv[1]) : 200);
}

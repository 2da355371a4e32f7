// The forms of a calibration's solve, from the drawn finger. All frames, their
// contacts and the parameters in one ceres::Problem (DENSE_SCHUR): reduced
// (SolveJointly) and weighted (SolveJointlyWeighted). And summed (SolveSummed):
// each frame's contacts are eliminated once in every pass, from where
// SolveJointly of 210 frames ends, as a calibration begins it. The error is the
// worst parameter's distance from the reduced form's solution under a tight
// tolerance, in std of the log.
//
//   build/test/tests/calibration_forms_study [FRAMES ...]
//
// takes evenly spread frames of the bundled log, by default 15, 30 and 60.
//
//   build/test/tests/calibration_forms_study LOG.csv FRAMES ...
//
// takes those of another log of that finger, reduced and summed.

#include <glog/logging.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/solve/summed_solve.h"
#include "finray/calib/solve/weighted_solve.h"
#include "finray/finger/finger_yaml.h"

namespace finray {
namespace {

constexpr JointLimits kLimits{200, 1e-9}, kTight{200, 1e-15};

/// A form's solution for these frames and what it took.
struct FormRun {
  SolveReport report;
  Eigen::VectorXd values;
  double cpu_s = 0;
};

template <class Solve>
FormRun RunForm(const CalibrationProblem& whole, const std::vector<int>& frames,
                const JointLimits& limits, Solve solve) {
  const auto part = whole.Part(frames, 1);
  ContactStore contacts(part.get());
  const std::clock_t start = std::clock();
  FormRun run;
  run.report = solve(frames, limits, part.get(), &contacts);
  run.cpu_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  run.values = part->Values();
  return run;
}

std::vector<int> Spread(const std::vector<int>& all, int count) {
  std::vector<int> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(all[static_cast<std::size_t>(i) * all.size() / count]);
  }
  return frames;
}

SolveReport SolveInTwoSteps(const std::vector<int>& frames,
                            const JointLimits& limits,
                            CalibrationProblem* problem,
                            ContactStore* contacts) {
  constexpr std::size_t kFew = 210;
  SolveJointly(Spread(frames, static_cast<int>(std::min(kFew, frames.size()))),
               limits, problem, contacts);
  return SolveSummed(frames, {}, problem, contacts).report;
}

void RunForms(CalibrationProblem* problem, int count, bool weighted) {
  const std::vector<int> frames = Spread(problem->candidates(), count);
  const FormRun exact = RunForm(*problem, frames, kTight, SolveJointly);
  const auto part = problem->Part(frames, 1);
  ContactStore contacts(part.get());
  SolveJointly(frames, kTight, part.get(), &contacts);
  const auto at = FitFrames(frames, part.get(), &contacts);
  if (!at) {
    std::fprintf(stderr, "%d frames: no solution to compare with\n", count);
    std::exit(3);
  }
  const std::vector<double> found = AnalyzeIdentifiability(part.get(), *at).std;
  const Eigen::Map<const Eigen::ArrayXd> std(
      found.data(), static_cast<Eigen::Index>(found.size()));
  const auto print = [&](const char* form, const FormRun& run) {
    const double error =
        ((run.values - exact.values).array() / std).abs().maxCoeff();
    std::printf("%d,%s,%.4f,%d,%s,%.3g\n", count, form, run.cpu_s,
                run.report.iterations, run.report.converged ? "yes" : "no",
                error);
    std::fflush(stdout);
  };
  print("reduced", RunForm(*problem, frames, kLimits, SolveJointly));
  if (weighted) {
    print("weighted", RunForm(*problem, frames, kLimits, SolveJointlyWeighted));
  } else {
    print("summed", RunForm(*problem, frames, kLimits, SolveInTwoSteps));
  }
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  using namespace finray;
  FLAGS_minloglevel = 3;  // Ceres warns of each step that fails
  google::InitGoogleLogging(argv[0]);
  const Finger drawn =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  const std::string first = argc > 1 ? argv[1] : "";
  const bool other = first.find(".csv") != std::string::npos;
  const std::string log =
      other ? first : FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv";
  CalibrationProblem problem(drawn, plan,
                             ReadCalibrationLogs({log}, drawn, plan), {}, 1);
  std::printf("frames,form,cpu_s,iterations,converged,error_std\n");
  if (argc < 2) {
    for (const int count : {15, 30, 60}) RunForms(&problem, count, true);
  }
  for (int i = other ? 2 : 1; i < argc; ++i) {
    RunForms(&problem, std::atoi(argv[i]), !other);
  }
}

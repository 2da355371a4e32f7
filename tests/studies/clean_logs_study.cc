// How often a clean log in recorded order is not `good`: of each noise, half of
// the logs are presses in and out, half are single touches. The finger is that
// of finray itself, so this counts false alarms only.
//   clean_logs_study [logs of each noise [threads]]

#include <cstdio>
#include <cstdlib>

#include "calib/recorded_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

std::string TouchesLog(const TempFolder& folder, const Finger& finger,
                       unsigned seed) {
  FrameTable frames = StandardFrames(finger, seed);
  std::vector<double>& time_s = frames.MutableNumbers("time_s");
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    time_s[i] = 0.2 * static_cast<double>(i);
  }
  MakeLog(finger, frames, {0.02, 0.05, seed}).Write(folder.Path("touches.csv"));
  return folder.Path("touches.csv");
}

bool IsGood(double noise_rad, unsigned seed, int threads) {
  const TempFolder folder;
  const Finger truth = WithNoise(HiddenFinger(), noise_rad);
  const Finger start = WithNoise(Nominal(), noise_rad);
  const std::string log = seed % 2 == 0 ? RecordedLog(folder, truth, seed)
                                        : TouchesLog(folder, truth, seed);
  Plan plan = StandardPlan();
  FamilyPlan& origin =
      plan.families[static_cast<int>(ParameterFamily::kObjectOrigin)];
  origin.free = true;
  origin.prior_std = 0.5;
  CalibrationProblem problem(
      start, plan, ReadCalibrationLogs({log}, start, plan), {}, threads);
  const CalibrationResult result = Calibrate(&problem);
  if (result.Verdict() == "good") return true;
  std::printf("  %.0e rad, seed %u, %s: %s\n", noise_rad, seed,
              seed % 2 == 0 ? "presses" : "touches", result.Verdict().c_str());
  for (const std::string& doubt : result.doubts) {
    std::printf("    %s\n", doubt.c_str());
  }
  std::fflush(stdout);
  return false;
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  using namespace finray;
  const unsigned logs = argc > 1 ? std::atoi(argv[1]) : 72;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 2;
  for (const double noise_rad : {3e-4, 6e-4, 1e-3}) {
    unsigned good = 0;
    for (unsigned seed = 1; seed <= logs; ++seed) {
      good += IsGood(noise_rad, seed, threads);
    }
    std::printf("%.0e rad: %u of %u clean logs are not good\n", noise_rad,
                logs - good, logs);
  }
  return 0;
}

// What the uncertainty of the calibration costs a frame: one contact from the
// table, two by an equilibrium; and once a finger, the table.
//
//   build/test/tests/calibration_uncertainty_benchmark

#include <benchmark/benchmark.h>

#include "finray/sensing/calibration_uncertainty.h"
#include "sensing/uncertain_finger.h"
#include "test_finger.h"

namespace finray {
namespace {

Finger UncertainFinger() {
  Finger finger = PaperFinger();
  finger.calibration = TypicalCovariance(finger);
  return finger;
}

void BM_Table(benchmark::State& state) {
  const Finger finger = UncertainFinger();
  EquilibriumSolver solver(finger, {});
  for (auto _ : state) {
    CalibrationUncertainty uncertainty(finger, 0, &solver);
    benchmark::DoNotOptimize(uncertainty.empty());
  }
}
BENCHMARK(BM_Table)->Unit(benchmark::kMillisecond);

void BM_Frame(benchmark::State& state) {
  const Finger finger = UncertainFinger();
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty uncertainty(finger, 0, &solver);
  std::vector<PointContact> contacts(state.range(0));
  const std::vector<double> volts(finger.gauges.size(), 0.05);
  const Eigen::VectorXd weights =
      Eigen::VectorXd::Constant(finger.gauges.size(), 3000);
  int i = 0;
  for (auto _ : state) {
    i = (i + 1) % 1000;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      contacts[c] = {30 + 0.04 * i + 30 * c, 1 + 0.005 * i, 0};
    }
    benchmark::DoNotOptimize(uncertainty.Of(contacts, volts, weights));
  }
}
BENCHMARK(BM_Frame)
    ->ArgName("contacts")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace finray

BENCHMARK_MAIN();

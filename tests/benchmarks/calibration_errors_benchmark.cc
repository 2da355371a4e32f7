// What the errors of the calibration cost a frame: one contact on the surface,
// two by an equilibrium; and once a finger, the surface.
//
//   build/test/tests/calibration_errors_benchmark

#include <benchmark/benchmark.h>

#include "estimation/uncertain_finger.h"
#include "finray/fit/calibration_errors.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr int kFrames = 1000;

// Contacts that move along the finger while their forces grow.
std::vector<PointContact> ContactsOf(int frame, int count) {
  std::vector<PointContact> contacts;
  for (int c = 0; c < count; ++c) {
    contacts.push_back({30 + 0.04 * frame + 30 * c, 1 + 0.005 * frame, 0});
  }
  return contacts;
}

Measurements Row(const Finger& finger) {
  Measurements row;
  row.gauges_V.assign(finger.gauges.size(), 0.05);
  return row;
}

// With the cells that one contact along the finger comes to.
void BM_Surface(benchmark::State& state) {
  const Finger finger = UncertainFinger();
  const Measurements row = Row(finger);
  for (auto _ : state) {
    CalibrationErrors errors(finger, Scene::OfGauges(0), {});
    for (int i = 0; i < kFrames; ++i) {
      benchmark::DoNotOptimize(errors.Of(ContactsOf(i, 1), row));
    }
  }
}
BENCHMARK(BM_Surface)->Unit(benchmark::kMillisecond);

void BM_Frame(benchmark::State& state) {
  const Finger finger = UncertainFinger();
  const Measurements row = Row(finger);
  CalibrationErrors errors(finger, Scene::OfGauges(0), {});
  std::vector<std::vector<PointContact>> contacts;
  for (int i = 0; i < kFrames; ++i) {
    contacts.push_back(ContactsOf(i, static_cast<int>(state.range(0))));
    errors.Of(contacts.back(), row);  // makes the cell
  }
  std::size_t i = 0;
  for (auto _ : state) {
    i = (i + 1) % contacts.size();
    benchmark::DoNotOptimize(errors.Of(contacts[i], row));
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

// Contact sensing along a log, every solver warm: one contact, four gauges,
// noise of 1e-4 rad. Error: the worst difference of l_c from the least-squares
// solution on 96 elements, mm, every 50th frame.
//
//   build/test/tests/sensing_benchmark

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "finray/chain/forward.h"
#include "finray/chain/sensing.h"
#include "finray/sensing/contact_fit.h"
#include "finray/statics/equilibrium.h"
#include "sensing/ceres_contact_fit.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise_rad = 1e-4;
constexpr int kFrames = 4190;  // once there and back

struct Log {
  std::vector<PointContact> truth;
  std::vector<Eigen::VectorXd> angles;
  std::vector<double> arc;  // least squares, of every 50th frame
};

Finger LogFinger() {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = kNoise_rad;
  return finger;
}

Eigen::VectorXd Weights() {
  return Eigen::VectorXd::Constant(4, 1 / kNoise_rad);
}

LadderState StateOf(const Discretization& discretization,
                    const PointContact& contact) {
  EquilibriumSolver solver(LogFinger(), discretization);
  solver.Solve({contact});
  return solver.state();
}

const Log& TheLog() {
  static const Log log = [] {
    Log made;
    std::mt19937_64 generator(1);
    std::normal_distribution<double> noise(0, kNoise_rad);
    const Discretization fine{Scheme::kTaylor, 96};
    EquilibriumSolver solver(LogFinger(), fine);
    ContactFit fit(LogFinger(), fine);
    for (int i = 0; i < kFrames; ++i) {
      made.truth.push_back(
          {70 + 40 * std::sin(0.0015 * i), 4 + 3 * std::cos(0.006 * i), 0});
      solver.Solve({made.truth.back()});
      made.angles.push_back(solver.outputs().head(4));
      for (double& angle : made.angles.back()) angle += noise(generator);
      if (i % 50 != 0) continue;
      std::vector<PointContact> contacts = {made.truth.back()};
      fit.set_state(solver.state());
      fit.Fit(made.angles.back(), Weights(), &contacts);
      made.arc.push_back(contacts[0].arc_mm);
    }
    return made;
  }();
  return log;
}

class WorstError {
 public:
  void Add(int frame, double arc_mm) {
    if (frame % 50 != 0) return;
    worst_ = std::max(worst_, std::abs(arc_mm - TheLog().arc[frame / 50]));
  }
  double worst() const { return worst_; }

 private:
  double worst_ = 0;
};

// `fit(i)` estimates frame i from where frame i - 1 ended and returns l_c.
template <class Fit, class Restart>
void Run(benchmark::State& state, int frames, Restart restart, Fit fit) {
  TheLog();
  WorstError error;
  restart();
  for (int i = 0; i < frames; ++i) error.Add(i, fit(i));
  restart();
  int i = 0;
  for (auto _ : state) {
    if (i == frames) {
      state.PauseTiming();
      restart();
      i = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(fit(i++));
  }
  state.counters["error_mm"] = error.worst();
  state.counters["frames/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void Fit(benchmark::State& state, Scheme scheme, double tolerance) {
  const Discretization discretization{scheme, 12};
  ContactFit fit(LogFinger(), discretization);
  fit.set_tolerance(tolerance);
  std::vector<PointContact> contacts(1);
  const Eigen::VectorXd weights = Weights();
  const LadderState first = StateOf(discretization, TheLog().truth[0]);
  Run(
      state, kFrames,
      [&] {
        contacts[0] = TheLog().truth[0];
        fit.set_state(first);
      },
      [&](int i) {
        fit.Fit(TheLog().angles[i], weights, &contacts);
        return contacts[0].arc_mm;
      });
}

void Ceres(benchmark::State& state) {
  CeresContactFit fit(LogFinger(), {});
  PointContact contact;
  std::vector<double> volts(4);
  Run(
      state, 400, [&] { contact = TheLog().truth[0]; },
      [&](int i) {
        volts.assign(TheLog().angles[i].begin(), TheLog().angles[i].end());
        fit.Fit(volts, 1e-6, &contact);
        return contact.arc_mm;
      });
}

void Paper(benchmark::State& state) {
  const ChainLayout layout = MakeChainLayout(
      LogFinger(), static_cast<int>(state.range(0)), GaugeRule::kOverlap);
  ChainContact contact;
  Run(
      state, 50,
      [&] {
        const PointContact& first = TheLog().truth[0];
        contact = {first.arc_mm, first.normal_N, 0};
      },
      [&](int i) {
        contact = SenseContact(layout, TheLog().angles[i], contact).contact;
        return contact.arc_mm;
      });
}

void Register() {
  const auto fit = [](const char* name, Scheme scheme, double tolerance) {
    benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
      Fit(state, scheme, tolerance);
    })->Unit(benchmark::kMicrosecond);
  };
  fit("fit_taylor8", Scheme::kTaylor8, 1e-5);
  fit("fit_taylor", Scheme::kTaylor, 1e-5);
  fit("fit_taylor_to_rounding", Scheme::kTaylor, 1e-12);
  benchmark::RegisterBenchmark("ceres_solve", Ceres)
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("paper", Paper)
      ->Arg(100)
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  finray::Register();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

// Contact sensing along a log, every solver warm: one contact, four gauges,
// noise of 1e-4 rad. Errors: the worst differences of l_c and f_c from the
// least-squares solution on 96 elements. A table at the end compares all with
// the paper's formulation in the same run; with repetitions the fastest counts.
//
//   build/test/tests/sensing_benchmark --benchmark_repetitions=5

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "finray/chain/sensing.h"
#include "finray/ladder/instruction_set.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/frame_problem.h"
#include "finray/sensing/gauge_surface.h"
#include "finray/sensing/gauge_table.h"
#include "sensing/gauge_log.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kTolerance = 1e-5;
constexpr int kFrames = 4160;  // once there and back

const GaugeLog& TheLog() {
  static const GaugeLog log(kFrames);
  return log;
}

const std::vector<PointContact>& Best() {
  static const std::vector<PointContact> best =
      TheLog().LeastSquares({Scheme::kTaylor, 96});
  return best;
}

class WorstError {
 public:
  void Add(int frame, const PointContact& contact) {
    const PointContact& best = Best()[frame];
    arc_mm_ = std::max(arc_mm_, std::abs(contact.arc_mm - best.arc_mm));
    force_percent_ = std::max(
        force_percent_, 100 * std::abs(contact.normal_N / best.normal_N - 1));
  }
  double arc_mm() const { return arc_mm_; }
  double force_percent() const { return force_percent_; }

 private:
  double arc_mm_ = 0, force_percent_ = 0;
};

// `fit(i, contact)` estimates frame i from where frame i - 1 ended.
template <class Restart, class Fit>
void Run(benchmark::State& state, int frames, Restart restart, Fit fit) {
  Best();
  WorstError error;
  PointContact contact;
  restart();
  for (int i = 0; i < frames; ++i) {
    fit(i, &contact);
    error.Add(i, contact);
  }
  restart();
  int i = 0;
  for (auto _ : state) {
    if (i == frames) {
      state.PauseTiming();
      restart();
      i = 0;
      state.ResumeTiming();
    }
    fit(i, &contact);
    benchmark::DoNotOptimize(contact);
    ++i;
  }
  state.counters["error_mm"] = error.arc_mm();
  state.counters["error_%"] = error.force_percent();
  state.counters["frames/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

// `follow`: from what the last linearisation makes of the readings.
void Alone(benchmark::State& state, const Discretization& discretization,
           double tolerance, bool follow) {
  ContactFit fit(PaperFinger(), discretization);
  fit.set_tolerance(tolerance);
  std::vector<PointContact> contacts(1);
  Eigen::VectorXd angles(4);
  const Eigen::VectorXd weights = TheLog().weights.col(0);
  const LadderState first = TheLog().StateAt(discretization, 0);
  Run(
      state, kFrames,
      [&] {
        contacts[0] = TheLog().truth[0];
        fit.set_state(first);
      },
      [&](int i, PointContact* contact) {
        angles = TheLog().angles.col(i);
        const bool fitted = follow ? fit.Follow(angles, weights, &contacts)
                                   : fit.Fit(angles, weights, &contacts);
        if (!fitted) state.SkipWithError("lost");
        *contact = contacts[0];
      });
}

void OnSurface(benchmark::State& state, const Discretization& discretization) {
  const double most_N = GaugeTable::HeaviestForce_N(PaperFinger());
  const GaugeSurface surface(EquilibriumSolver(PaperFinger(), discretization),
                             0, {}, most_N);
  ContactSolution solution;
  PointContact last;
  Run(
      state, kFrames, [&] { last = TheLog().truth[0]; },
      [&](int i, PointContact* contact) {
        if (!surface.Fit(TheLog().angles.col(i), TheLog().weights.col(i),
                         most_N, last, &solution)) {
          state.SkipWithError("lost");
        }
        *contact = last = solution.contacts[0];
      });
}

void Ceres(benchmark::State& state) {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = GaugeLog::kNoise_rad;
  FrameProblem problem(finger, Scene(), {}, EquilibriumForm::kReduced, 100);
  ContactSolution solution;
  Measurements row;
  Run(
      state, 400,
      [&] {
        solution.contacts[0] = TheLog().truth[0];
        solution.state = TheLog().StateAt({}, 0);
      },
      [&](int i, PointContact* out) {
        row.gauges_V.assign(TheLog().angles.col(i).begin(),
                            TheLog().angles.col(i).end());
        const LadderState state = solution.state;
        problem.Fit({1, solution.contacts, 0, &state}, row, &solution);
        *out = solution.contacts[0];
      });
}

void Paper(benchmark::State& state, int joints) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), joints, GaugeRule::kOverlap);
  PointContact contact;
  Run(
      state, 50, [&] { contact = TheLog().truth[0]; },
      [&](int i, PointContact* out) {
        contact = SenseContact(layout, TheLog().angles.col(i), contact).contact;
        *out = contact;
      });
}

constexpr char kPaper[] = "paper, dense, n = 100";

class ComparingReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
      const auto counter = [&](const char* name) {
        return run.counters.at(name).value;
      };
      const Row row{run.run_name.function_name, counter("frames/s"),
                    counter("error_mm"), counter("error_%")};
      if (row.name == kPaper && row.rate > paper_rate_) paper_rate_ = row.rate;
      if (rows_.empty() || rows_.back().name != row.name) rows_.push_back(row);
      if (row.rate > rows_.back().rate) rows_.back() = row;
    }
  }

  void Compare() const {
    std::printf(
        "\n| solver | frames/s | l_c off, mm | f_c off, %% | times the "
        "paper's |\n|---|---|---|---|---|\n");
    for (const Row& row : rows_) {
      std::printf("| %s | %.0f | %.1e | %.1e | %.0f |\n", row.name.c_str(),
                  row.rate, row.error_mm, row.error_percent,
                  paper_rate_ > 0 ? row.rate / paper_rate_ : 0.0);
    }
  }

 private:
  struct Row {
    std::string name;
    double rate, error_mm, error_percent;
  };
  std::vector<Row> rows_;
  double paper_rate_ = 0;
};

void Register() {
  const auto add = [](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(name.c_str(), run)
        ->Unit(benchmark::kMicrosecond);
  };
  const auto name = [](const char* what, const Discretization& d) {
    return std::string(what) + ", " + SchemeName(d.scheme) + " " +
           std::to_string(d.resolution);
  };
  add(kPaper, [](benchmark::State& state) { Paper(state, 100); });
  add("ceres_solve", Ceres);
  // The paper's chain with a cost linear in n: the same links, joints and
  // gauges (equal to rounding: chain_test, Formulations), eliminated link by
  // link with exchanges of pivots, as a band matrix would be. Without them a
  // tridiagonal elimination meets zero pivots past the buckling load.
  for (const int n : {100, 200, 400}) {
    const Discretization chain{Scheme::kRigidChain, n};
    add(name("chain, linear", chain), [=](benchmark::State& state) {
      Alone(state, chain, kTolerance, true);
    });
  }
  const Discretization paper_like{Scheme::kTaylor8, 12};
  add(name("without prediction", paper_like), [=](benchmark::State& state) {
    Alone(state, paper_like, kTolerance, false);
  });
  add("to rounding, taylor 12", [=](benchmark::State& state) {
    Alone(state, {Scheme::kTaylor, 12}, 1e-12, true);
  });
  const Discretization all[] = {{Scheme::kTaylor4, 12}, {Scheme::kTaylor4, 24},
                                {Scheme::kTaylor4, 48}, {Scheme::kTaylor8, 12},
                                {Scheme::kTaylor8, 24}, {Scheme::kTaylor12, 12},
                                {Scheme::kTaylor, 12}};
  for (const Discretization& one : all) {
    add(name("alone", one),
        [=](benchmark::State& state) { Alone(state, one, kTolerance, true); });
  }
  // With one element a bay. Inside a bay the nodes of a coarse mesh are kinks,
  // and the time does not depend on the mesh.
  for (const Discretization& one : all) {
    if (one.resolution != 12) continue;
    add(name("surface", one),
        [=](benchmark::State& state) { OnSurface(state, one); });
  }
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  finray::Register();
  std::printf("instruction set: %s\n", finray::InstructionSetName(0));
  finray::ComparingReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.Compare();
  return 0;
}

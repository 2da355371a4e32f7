// Time and error of the forward equilibrium along a log: the paper's dense
// chain, the ladder of rigid links and the Taylor schemes, in one run.
//
//   build/test/tests/statics_benchmark [--benchmark_min_time=..]
//
// Every solver is warm, as on a log: from frame to frame the contact moves by
// up to 0.06 mm and the force changes by up to 0.018 N. Errors are against 96
// Taylor elements of order 16, of gauge angles and rib forces relative to the
// largest of their kind, the worst over the log.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "finray/chain/forward.h"
#include "finray/ladder/instruction_set.h"
#include "finray/ladder/ladder_kernel.h"
#include "finray/ladder/ladder_newton.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr int kFrames = 4190;  // once there and back
// Accuracy asked of every solver.
constexpr double kTolerance = 1e-6;

PointContact Frame(int i) {
  return {70 + 40 * std::sin(0.0015 * i), 4 + 3 * std::cos(0.006 * i), 0};
}

struct Result {
  Eigen::VectorXd gauges, ribs;
};

// Of every 50th frame.
const std::vector<Result>& Truth() {
  static const std::vector<Result> truth = [] {
    std::vector<Result> results;
    EquilibriumSolver solver(PaperFinger(), {Scheme::kTaylor, 96});
    for (int i = 0; i < kFrames; i += 50) {
      solver.Solve({Frame(i)});
      results.push_back({solver.outputs().head(solver.model().gauges()),
                         solver.state().q.tail(solver.model().ribs())});
    }
    return results;
  }();
  return truth;
}

class WorstError {
 public:
  void Add(int frame, const Eigen::VectorXd& gauges,
           const Eigen::VectorXd& ribs) {
    const Result& truth = Truth()[frame / 50];
    worst_ = std::max(
        {worst_, Relative(gauges, truth.gauges), Relative(ribs, truth.ribs)});
  }
  double worst() const { return worst_; }

 private:
  static double Relative(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
  }
  double worst_ = 0;
};

void Paper(benchmark::State& state) {
  const int joints = static_cast<int>(state.range(0));
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), joints, GaugeRule::kOverlap);
  // After a step of this size the error is of its square.
  const double last_step = std::sqrt(kTolerance);
  ChainState chain;
  WorstError error;
  for (int i = 0; i < kFrames; i += 50) {
    // Warm, as it is timed.
    if (!SolveForward(layout, Frame(i + 1), &chain) ||
        !ContinueForward(layout, Frame(i), last_step, &chain)) {
      state.SkipWithError("lost");
      return;
    }
    Eigen::VectorXd ribs(layout.ribs.size());
    for (int k = 0; k < ribs.size(); ++k) ribs[k] = chain.rib_tension(k);
    error.Add(i, layout.gauges * chain.theta, ribs);
  }
  SolveForward(layout, Frame(0), &chain);
  int i = 0;
  for (auto _ : state) {
    if (!ContinueForward(layout, Frame(i), last_step, &chain)) {
      state.SkipWithError("lost");
      break;
    }
    i = (i + 1) % kFrames;
  }
  state.counters["error"] = error.worst();
}

void Ladder(benchmark::State& state, Scheme scheme) {
  EquilibriumSolver solver(PaperFinger(),
                           {scheme, static_cast<int>(state.range(0))});
  solver.set_tolerance(kTolerance);
  std::vector<PointContact> contacts = {Frame(0)};
  WorstError error;
  for (int i = 0; i < kFrames; ++i) {
    contacts[0] = Frame(i);
    if (!solver.Solve(contacts)) {
      state.SkipWithError("lost");
      return;
    }
    if (i % 50 == 0) {
      error.Add(i, solver.outputs().head(solver.model().gauges()),
                solver.state().q.tail(solver.model().ribs()));
    }
  }
  solver.Reset();
  contacts[0] = Frame(0);
  solver.Solve(contacts);
  int i = 0;
  for (auto _ : state) {
    contacts[0] = Frame(i);
    if (!solver.Solve(contacts)) {
      state.SkipWithError("lost");
      break;
    }
    i = (i + 1) % kFrames;
  }
  state.counters["error"] = error.worst();
}

// The two passes of a Newton step of the default scheme in one instruction set.
void Pass(benchmark::State& state, int set, bool evaluate) {
  LadderNewton newton(PaperFinger(), {});
  newton.Converge({Frame(0)}, 1, SweepColumns::kNone);
  LadderFrame<double> frame = newton.frame();
  const LadderKernel& kernel = FindLadderKernel(Scheme::kTaylor, false, set);
  kernel.evaluate(frame, SweepColumns::kNone, false);
  for (auto _ : state) {
    if (evaluate) {
      kernel.evaluate(frame, SweepColumns::kNone, false);
    } else {
      benchmark::DoNotOptimize(kernel.sweep(frame, SweepColumns::kNone, false));
    }
  }
}

// Keeps what was measured, for the comparison at the end.
class ComparingReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.error_occurred || run.counters.count("error") == 0) continue;
      const bool repeated = run.aggregate_name == "median";
      if (run.run_type == Run::RT_Aggregate && !repeated) continue;
      measured_[run.run_name.str()] = {run.GetAdjustedCPUTime(),
                                       run.counters.at("error").value};
    }
  }

  void Compare() const {
    std::printf(
        "\n| the paper's chain | error | us | at least as exact and fastest | "
        "error | us | times faster |\n|---|---|---|---|---|---|---|\n");
    for (const auto& [name, paper] : measured_) {
      if (name.rfind("Paper", 0) != 0) continue;
      const std::pair<const std::string, Measured>* best = nullptr;
      for (const auto& other : measured_) {
        if (other.first.rfind("taylor", 0) == 0 &&
            other.second.error <= paper.error &&
            (best == nullptr || other.second.time_us < best->second.time_us)) {
          best = &other;
        }
      }
      if (best == nullptr) continue;
      std::printf("| %s | %.1e | %.0f | %s | %.1e | %.2f | %.0f |\n",
                  name.c_str(), paper.error, paper.time_us, best->first.c_str(),
                  best->second.error, best->second.time_us,
                  paper.time_us / best->second.time_us);
    }
  }

 private:
  struct Measured {
    double time_us, error;
  };
  std::map<std::string, Measured> measured_;
};

void Register() {
  benchmark::RegisterBenchmark("Paper", Paper)
      ->Arg(50)
      ->Arg(100)
      ->Arg(200)
      ->Arg(400)
      ->Unit(benchmark::kMicrosecond);
  const std::pair<Scheme, std::vector<int>> schemes[] = {
      {Scheme::kRigidChain, {100, 200, 400, 800, 1600}},
      {Scheme::kTaylor4, {12, 24, 48, 96, 192}},
      {Scheme::kTaylor8, {12, 24, 48}},
      {Scheme::kTaylor12, {12, 24}},
      {Scheme::kTaylor, {0, 24}}};
  for (const auto& [scheme, resolutions] : schemes) {
    for (const int resolution : resolutions) {
      benchmark::RegisterBenchmark(
          SchemeName(scheme).c_str(),
          [scheme = scheme](benchmark::State& state) { Ladder(state, scheme); })
          ->Arg(resolution)
          ->Unit(benchmark::kMicrosecond);
    }
  }
  for (int set = 0; set < InstructionSets(); ++set) {
    for (const bool evaluate : {true, false}) {
      const std::string name = std::string(evaluate ? "evaluate" : "sweep") +
                               "_" + InstructionSetName(set);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        Pass(state, set, evaluate);
      })->Unit(benchmark::kMicrosecond);
    }
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

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
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimation/gauge_log.h"
#include "finray/chain/sensing.h"
#include "finray/estimation/frame_problem.h"
#include "finray/estimation/gauge_table.h"
#include "finray/estimation/row_fit.h"
#include "finray/ladder/instruction_set.h"

namespace finray {
namespace {

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

// Each fit starts from the contact of the frame before and, without a surface,
// from its equilibrium.
void Fits(benchmark::State& state, const Discretization& discretization,
          RowFit::Model model) {
  const GaugeLog& log = TheLog();
  const double most_N = GaugeTable::HeaviestForce_N(log.finger);
  std::optional<ModelSurface> surface;
  if (model == RowFit::Model::kSurface) {
    surface.emplace(
        RowFit::SurfaceFor(log.finger, Scene(), discretization, most_N));
  }
  RowFit fit(log.finger, Scene(), discretization, surface ? &*surface : nullptr,
             most_N);
  const LadderState first = log.StateAt(discretization, 0);
  LadderState near;
  ContactStart start;
  start.count = 1;
  start.state = &near;
  ContactSolution found;
  Run(
      state, kFrames,
      [&] {
        start.contacts[0] = log.truth[0];
        near = first;
      },
      [&](int i, PointContact* contact) {
        fit.set_row(log.rows[i]);
        if (!fit.Fit(start, model, RowFit::kMostEvaluations, &found)) {
          state.SkipWithError("lost");
        }
        if (!surface) std::swap(near, found.state);
        *contact = start.contacts[0] = found.contacts[0];
      });
}

void Ceres(benchmark::State& state) {
  const GaugeLog& log = TheLog();
  FrameProblem problem(log.finger, Scene(), {}, EquilibriumForm::kReduced, 100);
  ContactSolution solution;
  Run(
      state, 400,
      [&] {
        solution.contacts[0] = log.truth[0];
        solution.state = log.StateAt({}, 0);
      },
      [&](int i, PointContact* out) {
        const LadderState near = solution.state;
        problem.Fit({1, solution.contacts, 0, &near}, log.rows[i], &solution);
        *out = solution.contacts[0];
      });
}

void Paper(benchmark::State& state, int joints) {
  const GaugeLog& log = TheLog();
  const ChainLayout layout =
      MakeChainLayout(log.finger, joints, GaugeRule::kOverlap);
  PointContact contact;
  Run(
      state, 50, [&] { contact = log.truth[0]; },
      [&](int i, PointContact* out) {
        const Eigen::Map<const Eigen::Vector4d> angles(
            log.rows[i].gauges_V.data());
        contact = SenseContact(layout, angles, contact).contact;
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
      Fits(state, chain, RowFit::Model::kEquilibria);
    });
  }
  add("to rounding, taylor 12", [=](benchmark::State& state) {
    Fits(state, {Scheme::kTaylor, 12}, RowFit::Model::kRounding);
  });
  const Discretization all[] = {{Scheme::kTaylor4, 12}, {Scheme::kTaylor4, 24},
                                {Scheme::kTaylor4, 48}, {Scheme::kTaylor8, 12},
                                {Scheme::kTaylor8, 24}, {Scheme::kTaylor12, 12},
                                {Scheme::kTaylor, 12}};
  for (const Discretization& one : all) {
    add(name("equilibria", one), [=](benchmark::State& state) {
      Fits(state, one, RowFit::Model::kEquilibria);
    });
  }
  // With one element a bay. Inside a bay the nodes of a coarse mesh are kinks,
  // and the time does not depend on the mesh.
  for (const Discretization& one : all) {
    if (one.resolution != 12) continue;
    add(name("surface", one), [=](benchmark::State& state) {
      Fits(state, one, RowFit::Model::kSurface);
    });
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

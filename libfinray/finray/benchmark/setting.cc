#include "finray/benchmark/setting.h"

#include <algorithm>

#include "finray/benchmark/runners.h"

namespace finray {
namespace {

constexpr double kForwardTolerance = 1e-6;
constexpr double kForwardRounding = 1e-14;

constexpr FrameBudget kFast = {16, 64}, kMedium = {16, 8}, kSlow = {16, 1},
                      kVerySlow = {4, 1};

// Makes runners of type R with the arguments that follow the case.
template <class R, class... Args>
RunnerMaker MakerOf(Args... args) {
  return
      [=](const BenchmarkCase& c) { return std::make_unique<R>(c, args...); };
}

// A discretization of the ladder, under its name in settings.
struct Ladder {
  std::string solver, words;
  Discretization discretization;
  FrameBudget budget;

  bool IsChain() const { return discretization.scheme == Scheme::kRigidChain; }
};

class Grid {
 public:
  Grid(const Finger& finger, bool quick) : quick_(quick) {
    MakeLadders(finger);
    for (const std::string scene : kBenchmarkScenes) {
      Forward(scene);
      Sensing(scene);
      Estimation(scene);
    }
  }

  std::vector<BenchmarkSetting> settings;

 private:
  void MakeLadders(const Finger& finger) {
    const std::pair<Scheme, int> schemes[] = {{Scheme::kTaylor4, 4},
                                              {Scheme::kTaylor8, 8},
                                              {Scheme::kTaylor12, 12},
                                              {Scheme::kTaylor, 16}};
    const std::pair<int, const char*> counts[] = {
        {1, "one element"}, {2, "two elements"}, {4, "four elements"}};
    ladders_ = {default_};
    for (const auto& [scheme, order] : schemes) {
      for (const auto& [a_bay, count] : counts) {
        // Order 16 reaches rounding with two elements.
        if (order == 16 && a_bay == 4) continue;
        ladders_.push_back(
            {"taylor" + std::to_string(order) + "x" + std::to_string(a_bay),
             "order " + std::to_string(order) + ", " + count + " a bay",
             {scheme, ElementsFor(finger, a_bay)},
             kFast});
      }
    }
    series_ = ladders_;
    for (const int n : {50, 100, 200, 400, 800, 1600}) {
      if (quick_ && n > 400) continue;
      ladders_.push_back({"chain" + std::to_string(n),
                          "linear-time chain, n = " + std::to_string(n),
                          {Scheme::kRigidChain, n},
                          n > 200 ? kMedium : FrameBudget{16, 32}});
    }
    check_ = {"taylor12x8",
              "order 12, eight elements a bay",
              {Scheme::kTaylor12, ElementsFor(finger, 8)},
              kMedium};
  }

  void Forward(const std::string& scene) {
    const auto add = [&](const Ladder& ladder, const char* how,
                         const char* words, double tolerance,
                         bool cold = false) {
      FrameBudget budget = ladder.budget;
      if (scene == "circle" || cold) budget.frames = std::min(budget.frames, 8);
      if (scene == "circle" && ladder.IsChain()) budget = kVerySlow;
      AddLadder("forward", scene, ladder, how, words, budget,
                MakerOf<LadderForward>(ladder.discretization, tolerance, cold));
    };
    for (const Ladder& ladder : ladders_) {
      // The joints of a chain touch an object too, which takes 0.1 s a frame
      // (docs/evidence/statics_accuracy.md).
      if (scene == "circle" && ladder.IsChain() &&
          ladder.solver != "chain200") {
        continue;
      }
      add(ladder, "warm", "", kForwardTolerance);
    }
    add(default_, "cold", ", cold", kForwardTolerance, true);
    add(default_, "to_rounding", ", to rounding", kForwardRounding);
    add(check_, "to_rounding", ", to rounding", kForwardRounding);
    if (scene != "circle" && scene != "two_contacts") {
      DenseChains("forward", scene);
    }
  }

  void Sensing(const std::string& scene) {
    if (scene == "no_contact") return;
    const auto add = [&](const Ladder& ladder, const char* how,
                         const char* words, RunnerMaker make) {
      AddLadder("sensing", scene, ladder, how, words, ladder.budget,
                std::move(make));
    };
    for (const Ladder& ladder : ladders_) {
      add(ladder, "alone", ", one by one",
          MakerOf<FrameByFrame>(ladder.discretization, false));
    }
    if (scene != "one_contact" && scene != "friction") return;
    for (const Ladder& ladder : series_) {
      add(ladder, "surface", ", on the load surface",
          MakerOf<FrameByFrame>(ladder.discretization, true));
    }
    Ceres("sensing", scene, "reduced", "alone", kMedium,
          MakerOf<CeresFrames>(EquilibriumForm::kReduced));
    Ceres("sensing", scene, "weighted", "alone", kMedium,
          MakerOf<CeresFrames>(EquilibriumForm::kWeighted));
    DenseChains("sensing", scene);
  }

  void Estimation(const std::string& scene) {
    for (const Ladder& ladder : ladders_) {
      const bool plain = ladder.solver == "default";
      const bool whole = scene == "one_contact" &&
                         (!ladder.IsChain() || ladder.solver == "chain100");
      const auto add = [&](const char* how, const char* words,
                           EstimatorUse use) {
        FrameBudget budget = ladder.budget;
        // In these every frame is searched.
        if (scene == "circle" || use == EstimatorUse::kSearch) {
          budget = {4, scene == "two_contacts" ? 4 : 16};
        }
        AddLadder(
            "estimation", scene, ladder, how, words, budget,
            MakerOf<Estimator>(ladder.discretization, use, FrameMethod::kFast));
      };
      if (whole || plain) add("block", ", log", EstimatorUse::kBlock);
      if (whole || plain) add("live", ", live", EstimatorUse::kLive);
      if (plain) add("search", ", every frame searched", EstimatorUse::kSearch);
    }
    if (scene != "one_contact" && scene != "friction") return;
    for (const auto& [form, method] :
         {std::pair("reduced", FrameMethod::kCeresReduced),
          std::pair("weighted", FrameMethod::kCeresWeighted)}) {
      Ceres(
          "estimation", scene, form, "search", kSlow,
          MakerOf<Estimator>(Discretization(), EstimatorUse::kSearch, method));
    }
  }

  // The residual blocks of a frame in ceres::Solve, on the default mesh.
  void Ceres(const char* task, const std::string& scene,
             const std::string& form, const char* how, FrameBudget budget,
             RunnerMaker make) {
    Add({{{task, scene, "ceres_" + form, how},
          "ceres::Solve on the residual blocks, equilibrium " + form,
          "ceres",
          0,
          SchemeName(Scheme::kTaylor),
          0},
         budget,
         std::move(make)});
  }

  // The paper's dense chain, with its own Newton method and with ceres::Solve.
  void DenseChains(const std::string& task, const std::string& scene) {
    const bool sensing = task == "sensing";
    const auto add = [&](const std::string& solver, const std::string& words,
                         const char* family, int n, FrameBudget budget,
                         std::optional<ceres::LinearSolverType> type) {
      Add({{{task, scene, solver + std::to_string(n),
             sensing ? "alone" : "warm"},
            words + ", n = " + std::to_string(n),
            family,
            n,
            "",
            0},
           budget,
           sensing ? MakerOf<ChainSenses>(n, type)
                   : MakerOf<ChainForward>(n, type)});
    };
    for (const int n : {25, 50, 100, 200}) {
      if ((sensing && n == 25) || (quick_ && n > 100)) continue;
      add("paper", "the paper's dense Newton", "paper", n,
          n > (sensing ? 50 : 100) ? kVerySlow : kSlow, std::nullopt);
    }
    for (const auto type : {ceres::DENSE_QR, ceres::DENSE_NORMAL_CHOLESKY,
                            ceres::SPARSE_NORMAL_CHOLESKY}) {
      const std::string words = ceres::LinearSolverTypeToString(type);
      std::string solver = "ceres_" + words;
      std::transform(solver.begin(), solver.end(), solver.begin(),
                     [](unsigned char c) { return std::tolower(c); });
      for (const int n : {40, 100}) {
        if (n > 40 && (quick_ || (sensing && scene != "one_contact"))) continue;
        add(solver, "ceres::Solve on the chain, " + words, "ceres", n,
            sensing ? kVerySlow : kSlow, type);
      }
    }
  }

  void AddLadder(const char* task, const std::string& scene,
                 const Ladder& ladder, const char* how, const char* words,
                 FrameBudget budget, RunnerMaker make) {
    const Discretization& discretization = ladder.discretization;
    Add({{{task, scene, ladder.solver, how},
          ladder.words + words,
          ladder.IsChain() ? "chain" : "taylor",
          ladder.IsChain() ? discretization.resolution : 0,
          SchemeName(discretization.scheme),
          discretization.resolution},
         budget,
         std::move(make)});
  }

  void Add(BenchmarkSetting setting) {
    if (quick_) {
      setting.budget.stretches = std::min(setting.budget.stretches, 4);
    }
    settings.push_back(std::move(setting));
  }

  bool quick_;
  const Ladder default_ = {
      "default", "default: order 16, refined by load", {}, kFast};
  Ladder check_;  // another scheme, which confirms the reference
  // Orders by elements a bay and the default; the same and the chains.
  std::vector<Ladder> series_, ladders_;
};

}  // namespace

std::vector<BenchmarkSetting> BenchmarkGrid(const Finger& finger, bool quick) {
  return Grid(finger, quick).settings;
}

}  // namespace finray

#include "finray/benchmark/setting.h"

#include <algorithm>

namespace finray {
namespace {

// As FrameFollower, so that settings differ in scheme alone.
constexpr double kSensingTolerance = 1e-8;
constexpr double kForwardTolerance = 1e-6;
constexpr double kRounding = 1e-14;
constexpr double kSensingRounding = 1e-12;

constexpr FrameBudget kFast = {16, 64}, kMedium = {16, 8}, kSlow = {16, 1},
                      kVerySlow = {4, 1};

class Grid {
 public:
  Grid(const Finger& finger, bool quick) : finger_(finger), quick_(quick) {}

  std::vector<BenchmarkSetting> Make() {
    for (const std::string& scene : BenchmarkScenes()) {
      Forward(scene);
      Sensing(scene);
      Estimation(scene);
    }
    return std::move(settings_);
  }

 private:
  struct Ladder {
    std::string solver, words;
    Discretization discretization;
    FrameBudget budget;
  };

  // The fast path: orders by elements a bay, and the default.
  std::vector<Ladder> Taylors() const {
    static const struct {
      Scheme scheme;
      int order;
    } kSchemes[] = {{Scheme::kTaylor4, 4},
                    {Scheme::kTaylor8, 8},
                    {Scheme::kTaylor12, 12},
                    {Scheme::kTaylor, 16}};
    static const char* kCounts[] = {"", "one element", "two elements", "",
                                    "four elements"};
    std::vector<Ladder> all = {
        {"default", "default: order 16, refined by load", {}, kFast}};
    for (const auto& [scheme, order] : kSchemes) {
      for (const int a_bay : {1, 2, 4}) {
        if (order == 16 && a_bay == 4) continue;  // rounding since two
        all.push_back(
            {"taylor" + std::to_string(order) + "x" + std::to_string(a_bay),
             "order " + std::to_string(order) + ", " + kCounts[a_bay] +
                 " a bay",
             {scheme, ElementsFor(finger_, a_bay)},
             kFast});
      }
    }
    return all;
  }

  std::vector<Ladder> Chains() const {
    std::vector<Ladder> all;
    for (const int n : {50, 100, 200, 400, 800, 1600}) {
      if (quick_ && n > 400) continue;
      all.push_back({"chain" + std::to_string(n),
                     "linear-time chain, n = " + std::to_string(n),
                     {Scheme::kRigidChain, n},
                     n > 200 ? kMedium : FrameBudget{16, 32}});
    }
    return all;
  }

  void Forward(const std::string& scene) {
    const auto add = [&](const Ladder& one, const char* how, double tolerance,
                         bool cold, const char* words) {
      const bool chain = one.discretization.scheme == Scheme::kRigidChain;
      FrameBudget budget = one.budget;
      if (scene == "circle" || cold) budget.frames = std::min(budget.frames, 8);
      if (scene == "circle" && chain) budget = kVerySlow;
      Add({{"forward", scene, one.solver, how},
           one.words + words,
           chain ? "chain" : "taylor",
           0,
           one.discretization,
           budget,
           [=](const BenchmarkCase& c) {
             return MakeLadderForward(c, one.discretization, tolerance, cold);
           }});
    };
    for (const Ladder& one : Taylors()) {
      add(one, "warm", kForwardTolerance, false, "");
    }
    for (const Ladder& one : Chains()) {
      // A chain's kinks touch an object too, which costs 0.1 s a frame
      // (docs/evidence/statics_accuracy.md).
      if (scene == "circle" && one.discretization.resolution != 200) continue;
      add(one, "warm", kForwardTolerance, false, "");
    }
    add(Taylors()[0], "cold", kForwardTolerance, true, ", cold");
    add(Taylors()[0], "to_rounding", kRounding, false, ", to rounding");
    // Another scheme beside the reference.
    add({"taylor12x8",
         "order 12, eight elements a bay",
         {Scheme::kTaylor12, ElementsFor(finger_, 8)},
         kMedium},
        "to_rounding", kRounding, false, ", to rounding");
    if (scene == "circle" || scene == "two_contacts") return;
    for (const int n : {25, 50, 100, 200}) {
      if (quick_ && n > 100) continue;
      AddChain({"forward", scene, "paper" + std::to_string(n), "warm"},
               "the paper's dense Newton", "paper", n,
               n > 100 ? kVerySlow : kSlow,
               [n](const BenchmarkCase& c) { return MakePaperForward(c, n); });
    }
    AddCeres("forward", scene, MakeCeresForward);
  }

  void Sensing(const std::string& scene) {
    if (scene == "no_contact") return;
    const auto add = [&](const Ladder& one, const char* how, const char* words,
                         auto make) {
      Add({{"sensing", scene, one.solver, how},
           one.words + words,
           one.discretization.scheme == Scheme::kRigidChain ? "chain"
                                                            : "taylor",
           0,
           one.discretization,
           one.budget,
           make});
    };
    const auto fit = [](const Ladder& one, double tolerance) {
      return [=](const BenchmarkCase& c) {
        return MakeFit(c, one.discretization, tolerance);
      };
    };
    for (const Ladder& one : Taylors()) {
      add(one, "alone", ", one by one", fit(one, kSensingTolerance));
    }
    for (const Ladder& one : Chains()) {
      add(one, "alone", ", one by one", fit(one, kSensingTolerance));
    }
    add(Taylors()[0], "to_rounding", ", to rounding",
        fit(Taylors()[0], kSensingRounding));
    const Ladder check = {"taylor12x8",
                          "order 12, eight elements a bay",
                          {Scheme::kTaylor12, ElementsFor(finger_, 8)},
                          kMedium};
    add(check, "to_rounding", ", to rounding", fit(check, kSensingRounding));
    if (scene != "one_contact" && scene != "friction") return;
    for (const Ladder& one : Taylors()) {
      add(one, "lanes", ", four frames in lanes", [=](const BenchmarkCase& c) {
        return MakeLanes(c, one.discretization, kSensingTolerance);
      });
    }
    for (const int n : {50, 100, 200}) {
      if (quick_ && n > 100) continue;
      AddChain({"sensing", scene, "paper" + std::to_string(n), "alone"},
               "the paper's dense Newton", "paper", n,
               n > 50 ? kVerySlow : kSlow,
               [n](const BenchmarkCase& c) { return MakePaperSensing(c, n); });
    }
    AddCeres("sensing", scene, MakeCeresSensing);
  }

  void Estimation(const std::string& scene) {
    std::vector<Ladder> all = Taylors();
    for (const Ladder& chain : Chains()) {
      if (chain.discretization.resolution == 100) all.push_back(chain);
    }
    for (const Ladder& one : all) {
      const auto add = [&](const char* how, const char* words,
                           EstimatorUse use) {
        FrameBudget budget = one.budget;
        // Where every frame is searched.
        if (scene == "two_contacts" || scene == "circle" ||
            use == EstimatorUse::kSearch) {
          budget = {4, scene == "two_contacts" ? 4 : 16};
        }
        Add({{"estimation", scene, one.solver, how},
             one.words + words,
             one.discretization.scheme == Scheme::kRigidChain ? "chain"
                                                              : "taylor",
             0,
             one.discretization,
             budget,
             [=](const BenchmarkCase& c) {
               return MakeEstimator(c, one.discretization, use);
             }});
      };
      const bool plain = one.solver == "default";
      const bool whole = scene == "one_contact";
      if (whole || plain) add("block", ", log", EstimatorUse::kBlock);
      if (whole || plain) add("live", ", live", EstimatorUse::kLive);
      if (plain) add("search", ", every frame searched", EstimatorUse::kSearch);
    }
  }

  template <class Make>
  void AddCeres(const char* task, const std::string& scene, Make make) {
    static const struct {
      CeresLinearSolver linear_solver;
      const char *name, *words;
    } kSolvers[] = {{CeresLinearSolver::kDenseQr, "ceres_dense_qr", "DENSE_QR"},
                    {CeresLinearSolver::kDenseNormalCholesky,
                     "ceres_dense_normal_cholesky", "DENSE_NORMAL_CHOLESKY"},
                    {CeresLinearSolver::kSparseNormalCholesky,
                     "ceres_sparse_normal_cholesky", "SPARSE_NORMAL_CHOLESKY"}};
    const bool sensing = std::string(task) == "sensing";
    for (const auto& [linear_solver, name, words] : kSolvers) {
      for (const int n : {40, 100}) {
        if (n > 40 && (quick_ || (sensing && scene != "one_contact"))) continue;
        AddChain(
            {task, scene, name + std::to_string(n), sensing ? "alone" : "warm"},
            "ceres::Solve on the chain, " + std::string(words), "ceres", n,
            sensing ? kVerySlow : kSlow,
            [=, solver = linear_solver](const BenchmarkCase& c) {
              return make(c, n, solver);
            });
      }
    }
  }

  void AddChain(
      const SettingName& name, const std::string& words, const char* family,
      int links, FrameBudget budget,
      std::function<std::unique_ptr<Runner>(const BenchmarkCase&)> make) {
    Add({name,
         words + ", n = " + std::to_string(links),
         family,
         links,
         {},
         budget,
         std::move(make)});
  }

  void Add(BenchmarkSetting setting) {
    if (setting.discretization.scheme == Scheme::kRigidChain) {
      setting.links = setting.discretization.resolution;
    }
    if (quick_) {
      setting.budget.stretches = std::min(setting.budget.stretches, 4);
    }
    settings_.push_back(std::move(setting));
  }

  const Finger& finger_;
  bool quick_;
  std::vector<BenchmarkSetting> settings_;
};

}  // namespace

std::vector<BenchmarkSetting> BenchmarkGrid(const Finger& finger, bool quick) {
  return Grid(finger, quick).Make();
}

}  // namespace finray

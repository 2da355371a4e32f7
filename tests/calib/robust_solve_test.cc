#include "finray/calib/solve/robust_solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "calib/hard_log.h"
#include "calib/standard_log.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/solve/outliers.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

struct HardCase {
  HardCase(const HardLogKind& kind, unsigned seed)
      : hard(MakeHardLog(kind, seed)), plan(HardPlan(kind)) {
    hard.log.Write(folder.Path("log.csv"));
    const Finger start = HardStart(hard);
    problem = std::make_unique<CalibrationProblem>(
        start, plan, ReadCalibrationLogs({folder.Path("log.csv")}, start, plan),
        Discretization(), 2);
    solution = SolveRobustly(problem.get());
  }

  void ExpectTruth() {
    EXPECT_TRUE(solution.solve.converged);
    const Identifiability found =
        AnalyzeIdentifiability(problem.get(), solution.at);
    const CalibrationParameters& parameters = problem->parameters();
    for (std::size_t i = 0; i < parameters.free().size(); ++i) {
      const CalibrationParameter& p = parameters.FreeParameter(i);
      if (!p.of_finger) continue;
      EXPECT_LT(std::abs(p.Value(*p.variable) -
                         ParameterValue(hard.truth, *p.of_finger)),
                4 * p.ValueStd(*p.variable, found.std[i]))
          << p.name;
    }
  }

  TempFolder folder;
  HardLog hard;
  Plan plan;
  std::unique_ptr<CalibrationProblem> problem;
  CalibrationSolution solution;
};

TEST(RobustSolveTest, ACleanLogRejectsNothing) {
  HardCase clean(kHardLogKinds[0], 1);
  clean.ExpectTruth();
  EXPECT_TRUE(clean.problem->rejected().empty());
  for (const StartReport& start : clean.solution.starts) {
    EXPECT_TRUE(start.agrees) << start.name;
  }
}

// Outliers, dropouts and drift at once.
TEST(RobustSolveTest, ANastyLogIsCleaned) {
  for (const unsigned seed : {8u, 10u}) {  // these went wrong without rejection
    HardCase nasty(kHardLogKinds[2], seed);
    nasty.ExpectTruth();
    std::size_t found = 0, false_alarms = 0;
    for (const auto& [frame, reason] : nasty.problem->rejected()) {
      const int row = nasty.problem->logs().frames[frame].row;
      nasty.hard.outliers.count(row) > 0 ? ++found : ++false_alarms;
      EXPECT_FALSE(reason.empty());
    }
    // Some are no outliers: what was changed has dropped out, or looks alike.
    EXPECT_GE(found, 17u) << "of " << nasty.hard.outliers.size();
    EXPECT_LE(false_alarms, 1u);
  }
}

TEST(RobustSolveTest, NamesWhatIsOff) {
  HardLog hard = MakeHardLog(kHardLogKinds[0], 2);
  hard.log.MutableNumbers("gauge_3_V")[17] += 0.3;
  hard.log.MutableNumbers("force_N")[33] += 2;
  hard.log.MutableNumbers("object_y_mm")[51] -= 4;
  const TempFolder folder;
  hard.log.Write(folder.Path("log.csv"));
  const Finger start = HardStart(hard);
  const Plan plan = StandardPlan();  // no robust loss
  CalibrationProblem problem(
      start, plan, ReadCalibrationLogs({folder.Path("log.csv")}, start, plan),
      {}, 2);
  SolveRobustly(&problem);
  ASSERT_EQ(problem.rejected().size(), 3u);
  EXPECT_EQ(problem.rejected().at(17).rfind("gauge 3 is off by", 0), 0u)
      << problem.rejected().at(17);
  EXPECT_EQ(problem.rejected().at(33).rfind("force is off by", 0), 0u)
      << problem.rejected().at(33);
  EXPECT_EQ(problem.rejected().count(51), 1u);
}

// While it lives, what is allocated lies here and there.
class FragmentedHeap {
 public:
  explicit FragmentedHeap(unsigned seed) {
    std::mt19937 random(seed);
    for (auto& block : blocks_) block.reset(new char[8 + random() % 200]);
    std::shuffle(blocks_.begin(), blocks_.end(), random);
    for (std::size_t i = 0; i < blocks_.size(); i += 2) blocks_[i].reset();
  }

 private:
  std::vector<std::unique_ptr<char[]>> blocks_ =
      std::vector<std::unique_ptr<char[]>>(4000);
};

void ExpectSameCosts(const std::vector<StartReport>& a,
                     const std::vector<StartReport>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].solve.final_cost, b[k].solve.final_cost) << a[k].name;
  }
}

// The starts, the search for outliers and the sums.
TEST(RobustSolveTest, ThreadsDoNotChangeTheResult) {
  const TempFolder folders[5];
  std::vector<std::string> paths;
  for (unsigned i = 0; i < 5; ++i) {
    FrameTable log =
        FrameTable::Read(StandardLog(folders[i], HiddenFinger(), 40 + i));
    log.MutableNumbers("gauge_3_V")[20] += 0.5;
    paths.push_back(folders[i].Path("outlier.csv"));
    log.Write(paths.back());
  }
  const Finger start = Nominal();
  const Plan plan = StandardPlan();
  std::vector<Eigen::VectorXd> values;
  std::vector<std::map<int, std::string>> rejected;
  std::vector<std::vector<StartReport>> starts;
  for (const int threads : {1, 2, 5}) {
    const FragmentedHeap heap(static_cast<unsigned>(threads));
    CalibrationProblem problem(
        start, plan, ReadCalibrationLogs(paths, start, plan), {}, threads);
    starts.push_back(SolveRobustly(&problem).starts);
    values.push_back(problem.Values());
    rejected.push_back(problem.rejected());
  }
  EXPECT_EQ(rejected[0].size(), 5u);
  for (int k = 1; k < 3; ++k) {
    EXPECT_EQ(values[k], values[0]);
    EXPECT_EQ(rejected[k], rejected[0]);
    ExpectSameCosts(starts[k], starts[0]);
  }
}

// More frames than the starts take, so that the last solve moves.
TEST(RobustSolveTest, TheToleranceIsTheDistanceToTheMinimum) {
  const TempFolder folders[5];
  std::vector<std::string> paths;
  for (unsigned i = 0; i < 5; ++i) {
    paths.push_back(StandardLog(folders[i], HiddenFinger(), 60 + i));
  }
  const Finger start = Nominal();
  const Plan plan = StandardPlan();
  Eigen::VectorXd minimum;
  Eigen::MatrixXd information;
  const auto distance_std = [&](double tolerance_std) {
    CalibrationProblem problem(start, plan,
                               ReadCalibrationLogs(paths, start, plan), {}, 2);
    problem.set_tolerance_std(tolerance_std);
    const CalibrationSolution solution = SolveRobustly(&problem);
    const Eigen::VectorXd values = problem.Values();
    if (minimum.size() == 0) {
      minimum = values;
      information =
          SumsWithPriors(solution.at, problem.parameters()).information;
    }
    const Eigen::VectorXd off = values - minimum;
    return std::sqrt(std::max(0.0, off.dot(information * off)));
  };
  distance_std(1e-7);
  const double usual = distance_std(1e-2), coarse = distance_std(10);
  EXPECT_LT(usual, 1e-2);
  EXPECT_LT(usual, coarse);
  EXPECT_LT(coarse, 10);
}

// Ceres orders blocks by address; ours are to be in their own order.
TEST(RobustSolveTest, TheHeapDoesNotChangeTheResult) {
  const TempFolder folder;
  const Finger start = Nominal();
  const Plan plan = StandardPlan();
  const CalibrationLogs logs = ReadCalibrationLogs(
      {StandardLog(folder, HiddenFinger(), 40)}, start, plan);
  std::vector<Eigen::VectorXd> values;
  std::vector<std::vector<StartReport>> starts;
  for (unsigned i = 0; i < 3; ++i) {
    const FragmentedHeap heap(i);
    CalibrationProblem problem(start, plan, logs, {}, 1);
    starts.push_back(SolveRobustly(&problem).starts);
    values.push_back(problem.Values());
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(values[i], values[0]);
    ExpectSameCosts(starts[i], starts[0]);
  }
}

// To solve for it would take minutes, as the plan has no robust loss.
TEST(RobustSolveTest, AForceThatNoFingerTakesIsLeftOut) {
  HardLog hard = MakeHardLog(kHardLogKinds[0], 2);
  hard.log.MutableNumbers("force_N")[33] = 1e5;
  const TempFolder folder;
  hard.log.Write(folder.Path("log.csv"));
  const Finger start = HardStart(hard);
  const Plan plan = StandardPlan();
  CalibrationProblem problem(
      start, plan, ReadCalibrationLogs({folder.Path("log.csv")}, start, plan),
      {}, 2);
  const CalibrationSolution solution = SolveRobustly(&problem);
  EXPECT_TRUE(solution.settled);
  ASSERT_EQ(problem.rejected().size(), 1u);
  EXPECT_EQ(problem.rejected().at(33),
            "a force of 1e+05 N is more than any finger like it takes");
}

// A model that is wrong everywhere is no reason to reject frames.
TEST(RobustSolveTest, NoiseBeyondThePlanIsNoOutlier) {
  HardLogKind loud = kHardLogKinds[0];
  loud.noise = 4;
  HardLog hard = MakeHardLog(loud, 3);
  const TempFolder folder;
  hard.log.Write(folder.Path("log.csv"));
  Finger start = HardStart(hard);
  for (Gauge& gauge : start.gauges) gauge.noise_V /= 4;
  Plan plan = StandardPlan();
  plan.force_std_N *= 4;  // which decides what is a free frame
  CalibrationProblem problem(
      start, plan, ReadCalibrationLogs({folder.Path("log.csv")}, start, plan),
      {}, 2);
  const CalibrationSolution solution = SolveRobustly(&problem);
  EXPECT_TRUE(solution.solve.converged);
  EXPECT_TRUE(problem.rejected().empty());
  double chi2 = 0;
  for (const double r : solution.at.residuals) chi2 += r * r;
  EXPECT_NEAR(std::sqrt(chi2 / solution.at.residuals.size()), 4, 1);
}

}  // namespace
}  // namespace finray

#include "finray/benchmark/setting.h"

#include <gmock/gmock.h>

#include <set>

#include "finray/benchmark/measurement.h"
#include "test_finger.h"

namespace finray {
namespace {

// Of one stretch, a few frames each, by solver/how.
std::map<std::string, Measurement> Measured(const std::string& prefix,
                                            const std::string& scene,
                                            std::set<std::string> wanted) {
  const Finger finger = PaperFinger();
  std::vector<BenchmarkSetting> grid;
  for (BenchmarkSetting& setting : BenchmarkGrid(finger, true)) {
    if (setting.name.task != prefix || setting.name.scene != scene ||
        wanted.count(setting.name.solver) == 0) {
      continue;
    }
    setting.budget.stretches = 1;
    setting.budget.frames = std::min(setting.budget.frames, 8);
    grid.push_back(std::move(setting));
  }
  MeasuringOptions options;
  options.rounds = 1;
  std::map<std::string, Measurement> found;
  for (const Measurement& m :
       MeasureSettings(grid, {MakeBenchmarkCase(finger, scene, 1)}, options)) {
    found[m.name.solver + "/" + m.name.how] = m;
    EXPECT_EQ(m.solved_percent, 100) << m.name.id();
    EXPECT_EQ(m.time_us.size(), 1u);
  }
  return found;
}

TEST(SettingTest, IdsAreUniqueAndStable) {
  std::set<std::string> ids;
  for (const BenchmarkSetting& setting : BenchmarkGrid(PaperFinger(), false)) {
    EXPECT_TRUE(ids.insert(setting.name.id()).second) << setting.name.id();
  }
  for (const char* id : {"sensing/one_contact/taylor8x1/surface",
                         "sensing/one_contact/paper100/alone",
                         "sensing/one_contact/ceres_dense_qr40/alone",
                         "forward/circle/default/warm",
                         "estimation/one_contact/default/block"}) {
    EXPECT_EQ(ids.count(id), 1u) << id;
  }
}

// Rigid links are of order 2, dense or linear in time; series fall far faster.
TEST(SettingTest, ForwardErrorsAreAsTheOrders) {
  const auto found = Measured(
      "forward", "one_contact",
      {"chain50", "chain100", "chain200", "paper50", "paper100", "taylor4x1",
       "taylor4x2", "taylor8x1", "taylor8x2", "taylor12x8", "ceres_dense_qr40",
       "ceres_dense_normal_cholesky40", "ceres_sparse_normal_cholesky40"});
  const auto error = [&](const char* name) {
    return found.at(name).errors.tip_mm;
  };
  // Half the length of links makes a quarter of the error.
  for (const auto& [coarse, fine] :
       {std::pair("chain50/warm", "chain100/warm"),
        std::pair("chain100/warm", "chain200/warm")}) {
    EXPECT_NEAR(error(coarse) / error(fine), 4, 2) << coarse;
  }
  // The paper's own equations: the same links but for how the contact sits.
  EXPECT_LT(error("paper100/warm"), 4 * error("chain100/warm"));
  EXPECT_GT(error("paper100/warm"), error("chain100/warm") / 4);
  EXPECT_GT(error("taylor4x1/warm"), 5 * error("taylor4x2/warm"));
  EXPECT_GT(error("taylor8x1/warm"), 50 * error("taylor8x2/warm"));
  // Another scheme confirms the reference.
  EXPECT_LT(error("taylor12x8/to_rounding"), 1e-11);
  // All linear solvers of Ceres end at the same place.
  EXPECT_NEAR(error("ceres_dense_qr40/warm"),
              error("ceres_dense_normal_cholesky40/warm"), 1e-8);
  EXPECT_NEAR(error("ceres_dense_qr40/warm"),
              error("ceres_sparse_normal_cholesky40/warm"), 1e-8);
}

TEST(SettingTest, SensingAndEstimationFindTheLeastSquares) {
  const auto sensing = Measured(
      "sensing", "friction",
      {"default", "taylor8x1", "taylor8x2", "ceres_reduced", "ceres_weighted"});
  EXPECT_LT(sensing.at("ceres_reduced/alone").errors.contact_mm, 1e-5);
  EXPECT_LT(sensing.at("ceres_weighted/alone").errors.contact_mm, 1e-5);
  EXPECT_EQ(sensing.at("ceres_reduced/alone").unknowns, 2);
  EXPECT_EQ(sensing.at("ceres_weighted/alone").unknowns, 13);
  EXPECT_LT(sensing.at("default/alone").errors.contact_mm, 3e-6);
  EXPECT_LT(sensing.at("default/surface").errors.contact_mm, 3e-6);
  EXPECT_GT(sensing.at("taylor8x1/alone").errors.contact_mm, 1e-5);
  EXPECT_EQ(sensing.at("default/alone").unknowns, 65);
  const auto circle = Measured("sensing", "circle", {"default"});
  EXPECT_LT(circle.at("default/alone").errors.contact_mm, 3e-6);
  const auto estimation = Measured("estimation", "no_contact", {"default"});
  EXPECT_LT(estimation.at("default/block").errors.tip_mm, 1e-11);
}

TEST(SettingTest, TwoContactsAndObjects) {
  const auto two = Measured("forward", "two_contacts", {"default"});
  EXPECT_LT(two.at("default/warm").errors.gauges_rad, 1e-9);
  const auto circle = Measured("forward", "circle", {"taylor12x8"});
  EXPECT_LT(circle.at("taylor12x8/to_rounding").errors.contact_mm, 1e-10);
}

// The error of an answer is told, and one contact too few is none.
TEST(SettingTest, ErrorsAreTheLargest) {
  FrameAnswer truth{
      true, {{50, 2, 0}}, Eigen::Vector2d(0.1, 0.2), {1, 2, 0}, 1};
  FrameAnswer answer = truth;
  answer.contacts[0] = {50.5, 1.9, 0};
  answer.gauges_rad[1] += 1e-3;
  answer.tip_pose = {4, 6, 1};
  BenchmarkErrors errors;
  EXPECT_TRUE(errors.Add(answer, truth, false));
  EXPECT_TRUE(errors.Add(truth, truth, false));
  EXPECT_NEAR(errors.contact_mm, 0.5, 1e-12);
  EXPECT_NEAR(errors.normal_N, 0.1, 1e-12);
  EXPECT_NEAR(errors.normal_percent, 5, 1e-12);
  EXPECT_NEAR(errors.tip_mm, 5, 1e-12);
  EXPECT_NEAR(errors.gauges_rad, 1e-3, 1e-12);
  answer.contacts.clear();
  EXPECT_FALSE(errors.Add(answer, truth, false));
}

}  // namespace
}  // namespace finray

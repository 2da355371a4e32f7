// The public headers, used as a program outside would. No internal header is
// included here.

#include <ceres/gradient_checker.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "finray/finray.h"
#include "finray/residuals.h"

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr char kData[] = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";

finray::Finger PaperFinger() {
  return finray::Finger::Read(FINRAY_SOURCE_DIR
                              "/configs/fingers/paper_140mm.yaml");
}

Table Loads() {
  Table loads(3);
  loads.Set("contact_1_mm", {40, 70, 100});
  loads.Set("normal_1_N", {1, 2, 3});
  return loads;
}

Table OnlyGauges(const Table& simulated) {
  Table log(simulated.rows());
  for (int j = 1; j <= 4; ++j) {
    const std::string name = "gauge_" + std::to_string(j) + "_V";
    log.Borrow(name, simulated.At(name),
               std::make_shared<const Table>(simulated));
  }
  return log;
}

TEST(ApiTest, EstimatesWhatWasSimulated) {
  const finray::Finger finger = PaperFinger();
  const Simulation simulated = Simulator(finger).Simulate(Loads(), true);
  EXPECT_EQ(simulated.contact, 3);
  EXPECT_TRUE(simulated.shapes.Has("moment_N_mm"));
  const Table log = OnlyGauges(simulated.frames);
  const Estimation found = Estimator(finger).Estimate(log);
  EXPECT_EQ(found.summary.ok, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.statuses[i], FrameStatus::kOk);
    EXPECT_NEAR(found.numbers.At("contact_1_mm")[i],
                Loads().At("contact_1_mm")[i], 1e-4);
    EXPECT_NEAR(found.numbers.At("normal_1_N")[i], Loads().At("normal_1_N")[i],
                1e-5);
  }
  EXPECT_THAT(found.Merged(log).TextAt("status"),
              ElementsAre("ok", "ok", "ok"));
  ASSERT_FALSE(found.warnings.empty());  // the finger is not calibrated
}

TEST(ApiTest, LiveFramesAreThoseOfTheLog) {
  const finray::Finger finger = PaperFinger();
  const Table log = OnlyGauges(Simulator(finger).Simulate(Loads()).frames);
  LiveEstimator live(finger, finray::Scene::FromYaml("contacts: 1"));
  for (std::size_t row = 0; row < 3; ++row) {
    Readings readings;
    for (int j = 1; j <= 4; ++j) {
      readings.gauges_V.push_back(
          log.At("gauge_" + std::to_string(j) + "_V")[row]);
    }
    const Frame& frame = live.Next(readings);
    EXPECT_EQ(frame.status, FrameStatus::kOk);
    EXPECT_NEAR(frame.contact[0].arc_mm, Loads().At("contact_1_mm")[row], 1e-4);
  }
  EXPECT_THAT([&] { live.Next({}); }, ThrowsMessage<finray::InputError>(
                                          HasSubstr("expected 4 readings")));
}

TEST(ApiTest, ReadingsThatNoGaugeGivesAreBadInput) {
  const finray::Finger finger = PaperFinger();
  Table log = OnlyGauges(Simulator(finger).Simulate(Loads()).frames);
  const double infinity = std::numeric_limits<double>::infinity();
  log.Set("gauge_2_V", {infinity, log.At("gauge_2_V")[1], -9.9e37});
  const Estimation found = Estimator(finger).Estimate(log);
  EXPECT_THAT(found.statuses,
              ElementsAre(FrameStatus::kBadInput, FrameStatus::kOk,
                          FrameStatus::kBadInput));
  LiveEstimator live(finger, finray::Scene());
  Readings readings;
  readings.gauges_V = {0.01, -infinity, 0.01, 0.01};
  EXPECT_EQ(live.Next(readings).status, FrameStatus::kBadInput);
  EXPECT_TRUE(std::isnan(live.Next(readings).contact[0].normal_N));
  // Nothing explains these: neither the free finger nor a contact.
  readings.gauges_V = {-1, -1, -1, -1};
  EXPECT_EQ(live.Next(readings).status, FrameStatus::kUnobservable);
  EXPECT_TRUE(std::isnan(live.Next(readings).contact[0].normal_N));
}

TEST(ApiTest, BadInputSaysWhere) {
  EXPECT_THAT([] { finray::Finger::Read("missing.yaml"); },
              ThrowsMessage<finray::InputError>(HasSubstr("missing.yaml: ")));
  EXPECT_THAT([] { finray::Scene::FromYaml("contact: 1"); },
              ThrowsMessage<finray::InputError>(HasSubstr("scene:1:")));
  EXPECT_THAT([] { Loads().At("x"); },
              ThrowsMessage<finray::InputError>(HasSubstr("no column 'x'")));
  EstimateOptions options;
  options.solver = "fats";
  EXPECT_THAT([&] { Estimator(PaperFinger(), finray::Scene(), options); },
              ThrowsMessage<finray::InputError>(HasSubstr("found 'fats'")));
  options = {};
  options.threads = 100000;
  EXPECT_THAT([&] { Estimator(PaperFinger(), finray::Scene(), options); },
              ThrowsMessage<finray::InputError>(
                  "threads: expected 0 (all cores) to 1024, found 100000"));
  try {
    finray::Finger::Read("missing.yaml");
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
  }
}

TEST(ApiTest, StopEndsAnEstimate) {
  Table log(640);
  for (int j = 1; j <= 4; ++j) {
    log.Set("gauge_" + std::to_string(j) + "_V", std::vector<double>(640));
  }
  EXPECT_THROW(Estimator(PaperFinger()).Estimate(log, [] { return true; }),
               Interrupted);
}

TEST(ApiTest, CalibratesFromTablesAsFromFiles) {
  const finray::Plan plan = finray::Plan::Read(
      FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  const std::string path = std::string(kData) + "train.csv";
  const Calibration file =
      Calibration::Run(PaperFinger(), plan, std::vector<std::string>{path});
  const Calibration table = Calibration::Run(
      PaperFinger(), plan, std::vector<Table>{Table::Read(path)});
  EXPECT_EQ(file.verdict(), "good");
  EXPECT_TRUE(file.finger().calibrated());
  const auto a = file.parameters(), b = table.parameters();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].value, b[i].value) << a[i].name;
  }
  const std::size_t n = file.free_names().size();
  const std::vector<double> covariance = file.covariance();
  ASSERT_EQ(covariance.size(), n * n);
  EXPECT_DOUBLE_EQ(covariance[1], covariance[n]);
}

TEST(FrameResidualsTest, DerivativesAreThoseOfDifferences) {
  const FrameResiduals residuals(PaperFinger());
  const std::unique_ptr<ceres::CostFunction> state(
      residuals.StateOfParameters()),
      gauges(residuals.Gauges({0.01, 0.02, std::nan(""), 0.01}));
  double contact[] = {70, 2};
  double front = residuals.ln_front_stiffness(),
         back = residuals.ln_back_stiffness();
  std::vector<double> ribs = residuals.rib_lengths_mm();
  for (const auto& [cost, blocks] :
       {std::pair(state.get(), std::vector<const double*>{contact, &front,
                                                          &back, ribs.data()}),
        std::pair(gauges.get(), std::vector<const double*>{contact})}) {
    const ceres::GradientChecker checker(
        cost, static_cast<std::vector<const ceres::Manifold*>*>(nullptr), {});
    ceres::GradientChecker::ProbeResults results;
    // The differences end at the noise of equilibria that start from each
    // other.
    EXPECT_TRUE(checker.Probe(blocks.data(), 1e-4, &results))
        << results.error_log;
  }
  double of_gauges[4];
  const double* block[] = {contact};
  ASSERT_TRUE(gauges->Evaluate(block, of_gauges, nullptr));
  EXPECT_EQ(of_gauges[2], 0);  // not measured
}

TEST(FrameResidualsTest, StateIsThatOfTheSimulation) {
  const finray::Finger finger = PaperFinger();
  const Table seen = Simulator(finger).Simulate(Loads()).frames;
  const FrameResiduals residuals(finger);
  const std::unique_ptr<ceres::CostFunction> cost(residuals.State());
  const double contact[] = {70, 2};
  const double* block[] = {contact};
  std::vector<double> state(residuals.state_size());
  ASSERT_TRUE(cost->Evaluate(block, state.data(), nullptr));
  EXPECT_NEAR(state[0], seen.At("gauge_1_rad")[1], 1e-10);
  EXPECT_NEAR(state[residuals.contact_row(0)], seen.At("contact_1_x_mm")[1],
              1e-8);
  EXPECT_NEAR(state[residuals.tip_row() + 1], seen.At("tip_y_mm")[1], 1e-8);
}

}  // namespace
}  // namespace finray

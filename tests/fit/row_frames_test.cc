#include "finray/fit/row_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "count_allocations.h"
#include "finray/residuals/block_rows.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNaNReading = Measurements::kNotMeasured;

const std::vector<PointContact>& ContactsOfRows() {
  static const std::vector<PointContact> contacts = {{52, 2, 0}, {96, 1.5, 0}};
  return contacts;
}

std::vector<PointContact> FirstContacts(int count) {
  return {ContactsOfRows().begin(), ContactsOfRows().begin() + count};
}

class RowFramesTest : public testing::Test {
 protected:
  RowFramesTest() {
    finger_.gauges[1].curvature_per_rad = 0.8;
    finger_.gauges[2].flat_share = 0.1;
    finger_.gauges[3].noise_V = 5e-4;
    everything_.object = RigidObject{Outline(CircleOutline{15}), {}};
    everything_.object_std_mm = 0.05;
    everything_.pin_std_mm = 0.1;
    everything_.tip_std_mm = 0.2;
  }

  // Blocks do not ask whether the numbers fit any finger.
  Measurements SomeRow() {
    std::normal_distribution<double> number;
    const auto place = [&] {
      return Eigen::Vector2d(10 * number(generator_),
                             60 + 30 * number(generator_));
    };
    Measurements row;
    for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
      row.gauges_V.push_back(0.02 * number(generator_));
    }
    for (int i = 0; i < static_cast<int>(finger_.ribs.size()); ++i) {
      row.pins.push_back({i, Side::kFront, place()});
      row.pins.push_back({i, Side::kBack, place()});
    }
    row.tip_mm = place();
    row.object_mm = place();
    return row;
  }

  // The frame of the row, evaluated and linearised.
  LinearizedFrame At(const Measurements& row, int count, RowFrames* frames) {
    FrameFit::Shared shared;
    shared.parameters = frames->parameters().shared();
    FrameFit fit(frames->solver(), std::move(shared));
    LinearizedFrame at;
    EXPECT_TRUE(fit.Linearize(
        frames->Of(row, ContactsOfRows().data(), count),
        [](const double*, LadderState* state) { *state = {}; }, &at));
    return at;
  }

  // The blocks of the frames against those of this row alone, at the same
  // evaluation and with one of its own.
  void ExpectAsBuiltAnew(const Scene& scene, const Measurements& row, int count,
                         RowFrames* frames) {
    const LinearizedFrame at = At(row, count, frames);
    const FrameFit::Frame frame =
        frames->Of(row, ContactsOfRows().data(), count);
    const auto anew =
        MeasurementBlocks(row, MeasurementModel::OfScene(finger_, scene),
                          frames->parameters().frame(), finger_.gauges,
                          frame.evaluation, frame.contacts);
    ASSERT_EQ(frame.blocks->size(), anew.size());
    for (std::size_t i = 0; i < anew.size(); ++i) {
      const FrameBlock& block = (*frame.blocks)[i];
      EXPECT_EQ(block.family, anew[i].family);
      EXPECT_EQ(block.gauge, anew[i].gauge);
      EXPECT_EQ(block.std_V, anew[i].std_V);
      EXPECT_EQ(block.parameters, anew[i].parameters);
    }
    const std::unordered_map<const double*, int> column_of = {
        {frame.contacts, 0}};
    BlockRows got, expected;
    ASSERT_TRUE(got.Evaluate(*frame.blocks, column_of, 2 * count));
    ASSERT_TRUE(expected.Evaluate(anew, column_of, 2 * count));
    EXPECT_EQ(got.residuals, expected.residuals);
    EXPECT_EQ(got.jacobian, expected.jacobian);
    EXPECT_EQ(at.residuals, expected.residuals);

    RowFrames own(finger_, scene, {});
    const LinearizedFrame alone = At(row, count, &own);
    ASSERT_EQ(at.residuals.size(), alone.residuals.size());
    EXPECT_TRUE(at.residuals.isApprox(alone.residuals, 1e-9));
    EXPECT_TRUE(at.by_contact.isApprox(alone.by_contact, 1e-9));
  }

  // Rows that measure this and that, one after the other.
  std::vector<std::pair<std::string, Measurements>> ChangingRows() {
    std::vector<std::pair<std::string, Measurements>> rows;
    const auto add = [&](const char* name) -> Measurements& {
      return rows.emplace_back(name, SomeRow()).second;
    };
    add("all");
    add("other numbers");
    add("a gauge drops out").gauges_V[1] = kNaNReading;
    add("it comes back");
    {
      Measurements& row = add("another drops out as one comes back");
      row.gauges_V[0] = kNaNReading;
    }
    {
      Measurements& row = add("two are gone");
      row.gauges_V[1] = row.gauges_V[2] = kNaNReading;
    }
    add("all are there");
    add("means of four").gauge_readings = 4;
    add("single readings");
    add("the past leaves readings unknown").history_std_V = {1e-3, 0, 2e-4, 0};
    add("it is forgotten");
    add("no tip").tip_mm.setConstant(kNaNReading);
    add("a tip");
    add("half a place").object_mm.x() = kNaNReading;
    add("the other half").object_mm.y() = kNaNReading;
    add("no place").object_mm.setConstant(kNaNReading);
    add("a place");
    add("a pin is hidden").pins.pop_back();
    {
      Measurements& row = add("another pin is hidden");
      row.pins.erase(row.pins.begin() + 2);
    }
    {
      Measurements& row = add("pins in another order");
      std::swap(row.pins.front(), row.pins.back());
    }
    add("no pins").pins.clear();
    {
      Measurements& row = add("gauges alone");
      row.pins.clear();
      row.tip_mm.setConstant(kNaNReading);
      row.object_mm.setConstant(kNaNReading);
    }
    {
      Measurements& row = add("a camera alone");
      row.gauges_V.assign(row.gauges_V.size(), kNaNReading);
    }
    add("all again");
    return rows;
  }

  void ExpectChangingRowsAsBuiltAnew(const Scene& scene) {
    RowFrames frames(finger_, scene, {});
    for (const auto& [name, row] : ChangingRows()) {
      SCOPED_TRACE(name);
      for (const int count : {1, 0, 2}) {
        SCOPED_TRACE(count);
        ExpectAsBuiltAnew(scene, row, count, &frames);
      }
    }
  }

  std::mt19937_64 generator_{9};
  Finger finger_ = PaperFinger();
  Scene everything_;
};

TEST_F(RowFramesTest, RowsOfGauges) {
  ExpectChangingRowsAsBuiltAnew(Scene::OfGauges(0));
}

TEST_F(RowFramesTest, RowsWithPinsATipAndACircle) {
  ExpectChangingRowsAsBuiltAnew(everything_);
}

TEST_F(RowFramesTest, RowsWithACircleAlone) {
  Scene scene = everything_;
  scene.pin_std_mm.reset();
  scene.tip_std_mm.reset();
  ExpectChangingRowsAsBuiltAnew(scene);
}

// The next row has the same residuals with its numbers in them.
TEST_F(RowFramesTest, BlocksStay) {
  RowFrames frames(finger_, everything_, {});
  const auto costs = [&](const Measurements& row) {
    const FrameFit::Frame frame = frames.Of(row, ContactsOfRows().data(), 1);
    std::vector<const ceres::CostFunction*> all;
    for (const FrameBlock& block : *frame.blocks) {
      all.push_back(block.cost.get());
    }
    return all;
  };
  const auto before = costs(SomeRow());
  Measurements mean = SomeRow();
  mean.gauge_readings = 4;
  EXPECT_EQ(costs(mean), before);
  mean.gauges_V[0] = kNaNReading;
  EXPECT_EQ(costs(mean).size(), before.size() - 1);
  EXPECT_EQ(costs(SomeRow()).size(), before.size());
}

// A mean of four readings counts twice as much.
TEST_F(RowFramesTest, TheStdIsThatOfTheRow) {
  RowFrames frames(finger_, everything_, {});
  Measurements row = SomeRow();
  const LinearizedFrame single = At(row, 1, &frames);
  row.gauge_readings = 4;
  const LinearizedFrame mean = At(row, 1, &frames);
  ASSERT_EQ(mean.rows.size(), single.rows.size());
  int gauges = 0;
  for (std::size_t i = 0; i < mean.rows.size(); ++i) {
    const bool is_gauge = mean.rows[i].family == ResidualFamily::kGauge;
    gauges += is_gauge;
    const double factor = is_gauge ? 2 : 1;
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(mean.residuals[k], factor * single.residuals[k],
                1e-9 * std::abs(single.residuals[k]));
    if (!is_gauge) continue;
    EXPECT_EQ(mean.rows[i].std_V,
              finger_.gauges[mean.rows[i].gauge].noise_V / 2);
  }
  EXPECT_EQ(gauges, 4);
}

// Frames with one contact are there when the friction changes, those with two
// are not.
TEST_F(RowFramesTest, FrictionIsExchangedToo) {
  const Measurements row = SomeRow();
  RowFrames frames(finger_, Scene::OfGauges(0.1), {});
  const LinearizedFrame before = At(row, 1, &frames);
  frames.set_friction(-0.4);
  RowFrames other(finger_, Scene::OfGauges(-0.4), {});
  for (const int count : {1, 2}) {
    const LinearizedFrame at = At(row, count, &frames);
    const LinearizedFrame expected = At(row, count, &other);
    EXPECT_TRUE(at.residuals.isApprox(expected.residuals, 1e-9));
    EXPECT_TRUE(at.by_contact.isApprox(expected.by_contact, 1e-9));
  }
  EXPECT_FALSE(before.residuals.isApprox(At(row, 1, &frames).residuals, 1e-3));
  frames.set_friction(0.1);
  EXPECT_TRUE(before.residuals.isApprox(At(row, 1, &frames).residuals, 1e-9));
}

TEST_F(RowFramesTest, AnglesAreThoseOfTheLastFrame) {
  RowFrames frames(finger_, Scene::OfGauges(0), {});
  EquilibriumSolver solver(finger_, {});
  for (const int count : {1, 2, 0, 1}) {
    At(SomeRow(), count, &frames);
    ASSERT_TRUE(solver.Solve(FirstContacts(count)));
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(frames.GaugeAngle(j), solver.gauge_angle(j), 1e-10);
    }
  }
}

// Readings of the finger itself leave nothing.
TEST_F(RowFramesTest, ExactReadingsLeaveNothing) {
  RowFrames frames(finger_, Scene::OfGauges(0), {});
  EquilibriumSolver solver(finger_, {});
  for (const int count : {0, 1, 2}) {
    ASSERT_TRUE(solver.Solve(FirstContacts(count)));
    const LinearizedFrame at = At(CleanReadings(solver), count, &frames);
    ASSERT_EQ(at.residuals.size(), 4);
    EXPECT_LT(at.residuals.cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST_F(RowFramesTest, ResolutionIsAShareOfTheStd) {
  constexpr double kShare = 1e-3;
  const Finger linear = PaperFinger();
  const Scene gauges = Scene::OfGauges(0);
  const Eigen::VectorXd plain = RowFrames::Resolution(linear, gauges, kShare);
  ASSERT_EQ(plain.size(), 4);
  EXPECT_NEAR(plain[0], kShare * 3e-4, 1e-12);
  // A gauge with a curve is more sensitive somewhere.
  const Eigen::VectorXd curved = RowFrames::Resolution(finger_, gauges, kShare);
  EXPECT_EQ(curved[0], plain[0]);
  EXPECT_LT(curved[1], 0.9 * plain[1]);
  EXPECT_NEAR(curved[3], kShare * 5e-4, 1e-12);
  // The contact and the tip where they are measured.
  Scene circle = everything_;
  circle.tip_std_mm.reset();
  circle.object_std_mm = 1e-4;
  const Eigen::VectorXd place = RowFrames::Resolution(linear, circle, kShare);
  ASSERT_EQ(place.size(), 7);
  EXPECT_NEAR(place[4], kShare * 1e-4, 1e-15);
  EXPECT_EQ(place[5], place[4]);
  EXPECT_EQ(RowFrames::Resolution(linear, everything_, kShare).size(), 10);
}

#ifdef FINRAY_COUNTS_ALLOCATIONS

TEST_F(RowFramesTest, RowsWithTheSameMeasurementsAllocateNothing) {
  RowFrames frames(finger_, everything_, {});
  std::vector<Measurements> rows;
  for (int i = 0; i < 20; ++i) {
    rows.push_back(SomeRow());
    rows.back().gauge_readings = 1 + i % 3;
  }
  long before = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 1) before = allocations;
    frames.Of(rows[i], ContactsOfRows().data(), 1);
  }
  EXPECT_EQ(allocations - before, 0);
}

#endif

}  // namespace
}  // namespace finray

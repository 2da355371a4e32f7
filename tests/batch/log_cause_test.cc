#include "finray/batch/log_cause.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "estimation/uncertain_finger.h"
#include "finray/batch/batch_estimation.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Finger WellKnown() {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 3e-4;
  finger.calibration = TypicalCovariance(finger);
  finger.calibration->correlations.diagonal().setOnes();
  finger.calibration->std *= 0.1;
  return finger;
}

Scene NoneOrOne() {
  Scene scene;
  scene.most_contacts = 1;
  return scene;
}

using Change = std::function<void(std::size_t row, Measurements*)>;

struct World {
  double noise = 1, friction = 0, second = 0;
  bool force = false;
};

// The cause of a log of 240 rows: presses of 24 rows, a third of them free, by
// finray's own statics and a change of the readings.
LogCause CauseOf(const World& world, const Change& change = {}) {
  const Finger finger = WellKnown();
  EquilibriumSolver solver(finger, {});
  LogEvidence evidence(finger, NoneOrOne());
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  double place = 60, top = 2;
  for (std::size_t row = 1; row <= 240; ++row) {
    if (row % 24 == 1) {
      place = 25 + 80 * uniform(generator);
      top = 1 + 3 * uniform(generator);
    }
    const double force_N =
        top * std::max(0.0, std::sin(4.6 * static_cast<double>(row % 24) / 24));
    std::vector<PointContact> contacts;
    if (force_N > 0.05) {
      contacts.push_back({place, force_N, world.friction});
      if (world.second > 0) {
        contacts.push_back({place + 25, world.second * force_N});
      }
    }
    EXPECT_TRUE(solver.Solve(contacts));
    Measurements readings;
    readings.time_s = 0.02 * static_cast<double>(row);
    if (world.force) {
      readings.force_N = contacts.empty() ? 0 : force_N;
      readings.force_N += 0.01 * normal(generator);
    }
    for (int j = 0; j < 4; ++j) {
      const Gauge& gauge = finger.gauges[j];
      readings.gauges_V.push_back(gauge.Volts(solver.gauge_angle(j)) +
                                  world.noise * gauge.noise_V *
                                      normal(generator));
    }
    if (change) change(row, &readings);
    evidence.Add(readings);
  }
  return FindLogCause(evidence, finger, NoneOrOne(), {}, 2, true);
}

TEST(LogCauseTest, AGoodLogHasNone) {
  EXPECT_THAT(CauseOf({}).words, IsEmpty());
  EXPECT_THAT(CauseOf({1, 0, 0, true}).words, IsEmpty());
}

TEST(LogCauseTest, GaugesThatDoNotMoveAreNotToBeZeroed) {
  for (const double factor : {0.0, 1e-3}) {
    const LogCause cause =
        CauseOf({1, 0, 0, true}, [&](std::size_t, Measurements* row) {
          for (double& volts : row->gauges_V) volts *= factor;
        });
    EXPECT_THAT(cause.words, HasSubstr("V taken for mV?"));
    EXPECT_THAT(cause.remedy, Not(HasSubstr("finray_zero")));
  }
  const LogCause cause = CauseOf({}, [](std::size_t row, Measurements* its) {
    static Measurements held;
    if (row <= 100) held = *its;
    its->gauges_V = held.gauges_V;
  });
  EXPECT_THAT(cause.words, HasSubstr("the same from row 100 to 240"));
}

TEST(LogCauseTest, NamesWhatHasBeenDone) {
  const Finger finger = WellKnown();
  const auto gauge = [](int j, const std::function<double(double)>& to) {
    return [j, to](std::size_t, Measurements* row) {
      row->gauges_V[j] = to(row->gauges_V[j]);
    };
  };
  const double offset_V = finger.gauges[1].offset_V;
  std::mt19937_64 generator(8);
  std::normal_distribution<double> noise(0, 3e-4);
  const struct {
    World world;
    Change change;
    const char* words;
  } kCases[] = {
      {{},
       [](std::size_t, Measurements* row) {
         const double shift_V[] = {1.5e-3, -1e-3, 2.5e-3, -2e-3};
         for (int j = 0; j < 4; ++j) row->gauges_V[j] += shift_V[j];
       },
       "the gauges' offsets have moved"},
      {{},
       gauge(2, [](double v) { return v + 0.003; }),
       "gauge 3 has slipped: its offset alone has moved"},
      {{1, 0, 0, true},
       gauge(1, [&](double v) { return offset_V + 0.5 * (v - offset_V); }),
       "the gain of gauge 2 is not the finger's"},
      {{},
       gauge(1, [&](double v) { return 2 * offset_V - v; }),
       "gauge 2 has the wrong sign"},
      {{},
       [](std::size_t, Measurements* row) {
         std::swap(row->gauges_V[0], row->gauges_V[2]);
       },
       "gauges 1 and 3 are swapped"},
      {{2}, {}, "readings are noisier than noise_V says"},
      {{},
       [](std::size_t, Measurements* row) {
         for (double& v : row->gauges_V) v = std::round(v / 2e-3) * 2e-3;
       },
       "gauge 1 has steps of 2 mV"},
      {{},
       [](std::size_t row, Measurements* readings) {
         if (row > 100) readings->gauges_V[1] = 0.01;
       },
       "gauge 2 is stuck at 0.01 V from row 101"},
      {{},
       [&](std::size_t row, Measurements* readings) {
         if (row > 120) readings->gauges_V[0] = noise(generator);
       },
       "gauge 1 is dead from row 1"},
      {{1, 0, 0.8}, {}, "none of the effects that finray knows"},
  };
  for (const auto& one : kCases) {
    const LogCause cause = CauseOf(one.world, one.change);
    EXPECT_THAT(cause.words, HasSubstr(one.words)) << cause.details;
    EXPECT_THAT(cause.words, Not(HasSubstr("or as well")));
  }
}

TEST(LogCauseTest, SaysHowFarAndWhere) {
  const LogCause moved = CauseOf({}, [](std::size_t, Measurements* row) {
    for (double& v : row->gauges_V) v += 0.004;
  });
  EXPECT_EQ(moved.words, "the gauges' offsets have moved");
  EXPECT_THAT(moved.details, HasSubstr("offsets moved by +4, +4, +4, +4 mV"));
  EXPECT_THAT(moved.remedy, HasSubstr("finray_zero"));
  const LogCause two = CauseOf({1, 0, 0.8});
  EXPECT_THAT(two.details,
              AllOf(HasSubstr("chi2 is largest"), HasSubstr("instead of")));
}

}  // namespace
}  // namespace finray

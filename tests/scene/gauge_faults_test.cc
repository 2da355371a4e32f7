#include "finray/scene/gauge_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Presses of 60 rows with rests between them, read by three gauges; a change of
// the readings of each row.
std::vector<std::string> FaultsOf(
    const std::function<void(std::size_t row, std::vector<double>*)>& change,
    bool at_random = false) {
  Finger finger;
  finger.gauges.resize(3);
  GaugeFaultFinder finder(finger);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> noise(0, 3e-4);
  std::uniform_real_distribution<double> uniform;
  double place = 0;
  for (std::size_t row = 1; row <= 600; ++row) {
    if (at_random || row % 60 == 1) place = uniform(generator);
    const double phase =
        at_random ? uniform(generator) : static_cast<double>(row % 60) / 60;
    const double load = std::max(0.0, std::sin(9 * phase));
    std::vector<double> volts = {0.1 + 0.05 * load * (1.2 - place),
                                 0.2 - 0.08 * load * (0.3 + place),
                                 0.04 * load};
    for (double& v : volts) v += noise(generator);
    const double force_N = 3 * load;
    change(row, &volts);
    Measurements readings;
    readings.gauges_V = volts;
    readings.force_N = force_N;
    finder.Add(row, readings);
  }
  std::vector<std::string> words;
  for (const GaugeFault& fault : finder.Faults()) words.push_back(fault.words);
  return words;
}

TEST(GaugeFaultsTest, GoodGaugesHaveNone) {
  const auto nothing = [](std::size_t, std::vector<double>*) {};
  EXPECT_THAT(FaultsOf(nothing), IsEmpty());
  EXPECT_THAT(FaultsOf(nothing, true), IsEmpty());
  // Few digits, rows that a slow logger repeats, and missing cells.
  EXPECT_THAT(FaultsOf([](std::size_t, std::vector<double>* volts) {
                for (double& v : *volts) v = std::round(v / 4e-4) * 4e-4;
              }),
              IsEmpty());
  std::vector<double> held;
  EXPECT_THAT(FaultsOf([&](std::size_t row, std::vector<double>* volts) {
                if (row % 30 == 1) held = *volts;
                *volts = held;
              }),
              IsEmpty());
  EXPECT_THAT(FaultsOf([](std::size_t row, std::vector<double>* volts) {
                if (row > 200) (*volts)[1] = std::nan("");
              }),
              IsEmpty());
}

TEST(GaugeFaultsTest, NamesGaugeKindAndRows) {
  std::mt19937_64 generator(4);
  std::normal_distribution<double> noise(0, 3e-4);
  EXPECT_THAT(
      FaultsOf([](std::size_t row, std::vector<double>* volts) {
        if (row > 300 && row <= 400) (*volts)[1] = 0.17;
      }),
      ElementsAre("gauge 2 is stuck at 0.17 V from row 301 to 400 while the "
                  "others move"));
  EXPECT_THAT(FaultsOf([&](std::size_t, std::vector<double>* volts) {
                (*volts)[0] = 0.1 + noise(generator);
              }),
              ElementsAre(HasSubstr("gauge 1 is dead: it does not move")));
  EXPECT_THAT(FaultsOf([&](std::size_t row, std::vector<double>* volts) {
                if (row > 320) (*volts)[2] = noise(generator);
              }),
              ElementsAre(HasSubstr("gauge 3 is dead from row 3")));
  EXPECT_THAT(FaultsOf([](std::size_t, std::vector<double>* volts) {
                (*volts)[2] = std::min((*volts)[2], 0.035);
              }),
              ElementsAre(HasSubstr("gauge 3 is clipped: ")));
  EXPECT_THAT(FaultsOf(
                  [](std::size_t, std::vector<double>* volts) {
                    (*volts)[1] = std::max((*volts)[1], 0.15);
                  },
                  true),
              ElementsAre(HasSubstr("are exactly 0.15 V, its least")));
  EXPECT_THAT(FaultsOf([](std::size_t, std::vector<double>* volts) {
                (*volts)[0] = std::round((*volts)[0] / 0.002) * 0.002;
              }),
              ElementsAre("gauge 1 has steps of 2 mV, 6.7 times its noise_V"));
}

TEST(GaugeFaultsTest, AllGaugesThatDoNotMove) {
  for (const double factor : {0.0, 1e-3}) {
    EXPECT_THAT(FaultsOf([&](std::size_t, std::vector<double>* volts) {
                  for (double& v : *volts) v *= factor;
                }),
                ElementsAre(HasSubstr(
                    "gauges 1 to 3 do not move in 600 rows, not even by their "
                    "noise, while force_N varies by 3 N: dead")));
  }
  EXPECT_THAT(FaultsOf([](std::size_t, std::vector<double>* volts) {
                *volts = {0, std::nan(""), 0};
              }),
              ElementsAre(HasSubstr("gauges 1, 3 do not move in 600 rows")));
}

// A quiet finger rests on one step of coarse converters for most of a log.
TEST(GaugeFaultsTest, ARestOnCoarseStepsIsNotFrozen) {
  EXPECT_THAT(FaultsOf([](std::size_t row, std::vector<double>* volts) {
                if (row <= 540) *volts = {0.1, 0.2, 0};
                for (double& v : *volts) v = std::round(v / 5e-4) * 5e-4;
              }),
              IsEmpty());
}

TEST(GaugeFaultsTest, AFrozenLogger) {
  std::vector<double> held;
  const auto hold = [&](std::size_t first, std::size_t last, std::size_t k) {
    return FaultsOf(
        [&, first, last, k](std::size_t row, std::vector<double>* volts) {
          const bool frozen = row > first && row <= last;
          if (!frozen && (row % k == 0 || row == 1)) held = *volts;
          *volts = held;
        });
  };
  EXPECT_THAT(hold(300, 600, 1),
              ElementsAre("all gauges read the same from row 300 to 600: the "
                          "logger or its link has frozen"));
  EXPECT_THAT(hold(200, 400, 1), ElementsAre(HasSubstr("row 200 to 400")));
  EXPECT_THAT(hold(580, 600, 1), ElementsAre(HasSubstr("row 580 to 600")));
  // Each row is written many times, and in the end once more.
  EXPECT_THAT(hold(500, 600, 20), IsEmpty());
  EXPECT_THAT(hold(590, 600, 1), IsEmpty());
}

// At touches so light that the others move by less than 30 times their noise.
TEST(GaugeFaultsTest, AGaugeThatIsFrozenUnderLightTouches) {
  double held = 0;
  EXPECT_THAT(FaultsOf([&](std::size_t row, std::vector<double>* volts) {
                (*volts)[0] = 0.1 + 0.1 * ((*volts)[0] - 0.1);
                (*volts)[1] = 0.2 + 0.05 * ((*volts)[1] - 0.2);
                (*volts)[2] *= 0.1;
                for (double& v : *volts) v += 1e-7 * std::sin(7e3 * v * row);
                if (row == 251) held = (*volts)[1];
                if (row > 251) (*volts)[1] = held;
              }),
              ElementsAre(HasSubstr("from row 251 to 600 while the others")));
}

}  // namespace
}  // namespace finray

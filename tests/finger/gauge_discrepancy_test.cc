#include "finray/finger/gauge_discrepancy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "finray/finger/finger_yaml.h"
#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

Eigen::MatrixXd SquareOf(double a, double b, double across) {
  return (Eigen::MatrixXd(2, 2) << a, across, across, b).finished();
}

TEST(GaugeDiscrepancyTest, IsLinearBetweenPlacesAndGrowsWithLoad) {
  const GaugeDiscrepancy discrepancy{
      2, {{40, SquareOf(1, 4, 1)}, {80, SquareOf(3, 8, -1)}}};
  const auto at = [&](double arc_mm, double normal_N) {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(2, 2);
    discrepancy.AddTo(arc_mm, normal_N, &covariance);
    return covariance;
  };
  EXPECT_EQ(at(10, 0), SquareOf(1, 4, 1));
  EXPECT_EQ(at(40, 0), SquareOf(1, 4, 1));
  EXPECT_EQ(at(50, 0), SquareOf(1.5, 5, 0.5));
  EXPECT_EQ(at(50, 4), 5 * SquareOf(1.5, 5, 0.5));
  EXPECT_EQ(at(80, 0), SquareOf(3, 8, -1));
  EXPECT_EQ(at(130, 2), 2 * SquareOf(3, 8, -1));
}

constexpr char kHead[] =
    "schema_version: 1\n"
    "name: two\n"
    "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
    "beams:\n"
    "  front: {bending_stiffness_N_mm2: 12500}\n"
    "  back: {bending_stiffness_N_mm2: 12500}\n"
    "gauges:\n"
    "  - {beam: back, start_mm: 30, length_mm: 18}\n"
    "  - {beam: back, start_mm: 76, length_mm: 18}\n"
    "calibration:\n"
    "  parameters: [front_stiffness_N_mm2]\n"
    "  std: [100]\n"
    "  discrepancy:\n";

TEST(GaugeDiscrepancyTest, IsReadAndWritten) {
  const TempFolder folder;
  const Finger finger = ReadFinger(folder.Write(
      "finger.yaml", std::string(kHead) +
                         "    load_N: 3\n"
                         "    places:\n"
                         "      - {place_mm: 40, std_rad: [1e-3, 2e-3],"
                         " correlations: [[1], [0.5, 1]]}\n"
                         "      - {place_mm: 80, std_rad: [0, 3e-3]}\n"));
  ASSERT_TRUE(finger.calibration && finger.calibration->discrepancy);
  const GaugeDiscrepancy& read = *finger.calibration->discrepancy;
  EXPECT_EQ(read.load_N, 3);
  ASSERT_EQ(read.places.size(), 2u);
  EXPECT_TRUE(
      read.places[0].covariance_rad2.isApprox(SquareOf(1e-6, 4e-6, 1e-6)));
  EXPECT_TRUE(read.places[1].covariance_rad2.isApprox(SquareOf(0, 9e-6, 0)));
  const Finger again =
      ReadFinger(folder.Write("again.yaml", FingerToYaml(finger)));
  for (int p = 0; p < 2; ++p) {
    EXPECT_TRUE(
        again.calibration->discrepancy->places[p].covariance_rad2.isApprox(
            read.places[p].covariance_rad2));
  }
}

TEST(GaugeDiscrepancyTest, NonsenseIsRefusedWithItsPlace) {
  const TempFolder folder;
  const auto refused = [&](const std::string& block, const std::string& words) {
    const std::string path =
        folder.Write("finger.yaml", std::string(kHead) + block);
    EXPECT_THAT([&] { ReadFinger(path); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr(words)))
        << block;
  };
  refused("    load_N: 0\n    places: [{place_mm: 4, std_rad: [0, 0]}]\n",
          "load_N");
  refused("    load_N: 1\n    places: []\n", "places");
  refused("    load_N: 1\n    places: [{place_mm: 4, std_rad: [0]}]\n",
          "one a gauge");
  refused("    load_N: 1\n    places: [{place_mm: 4, std_rad: [0, -1]}]\n",
          "at least 0");
  refused(
      "    load_N: 1\n    places:\n"
      "      - {place_mm: 9, std_rad: [0, 1]}\n"
      "      - {place_mm: 4, std_rad: [0, 1]}\n",
      "from base to tip");
  refused(
      "    load_N: 1\n    places:\n"
      "      - {place_mm: 9, std_rad: [1, 1], correlations: [[1], [2, 1]]}\n",
      "from -1 to 1");
}

}  // namespace
}  // namespace finray

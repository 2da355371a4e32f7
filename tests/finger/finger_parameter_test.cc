#include "finray/finger/finger_parameter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "finray/io/error.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// The paper's finger and a random covariance of all its parameters.
Finger UncertainFinger() {
  Finger finger = PaperFinger();
  ParameterCovariance covariance;
  covariance.parameters = ParametersOf(finger);
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(generator); });
  const Eigen::MatrixXd product = root * root.transpose();
  covariance.std = product.diagonal().cwiseSqrt();
  covariance.correlations = covariance.std.cwiseInverse().asDiagonal() *
                            product *
                            covariance.std.cwiseInverse().asDiagonal();
  covariance.correlations.diagonal().setOnes();
  covariance.correlations.triangularView<Eigen::StrictlyUpper>() =
      covariance.correlations.transpose();
  finger.calibration = covariance;
  return finger;
}

TEST(ParameterCovarianceTest, RoundTripIsExact) {
  const Finger finger = UncertainFinger();
  const TempFolder folder;
  const std::string text = FingerToYaml(finger);
  const Finger back = ReadFinger(folder.Write("f.yaml", text));
  ASSERT_TRUE(back.calibration.has_value());
  EXPECT_EQ(back.calibration->parameters, ParametersOf(finger));
  EXPECT_EQ(back.calibration->std, finger.calibration->std);
  EXPECT_EQ(back.calibration->correlations, finger.calibration->correlations);
  EXPECT_EQ(FingerToYaml(back), text);
}

TEST(ParameterCovarianceTest, FrictionIsSaidWithItsCoefficient) {
  Finger finger = UncertainFinger();
  ParameterCovariance& covariance = *finger.calibration;
  covariance.parameters.back() = {FingerParameterKind::kFriction};
  covariance.friction = 0.31;
  const Eigen::Index last = covariance.std.size() - 1;
  covariance.std[last] = 0.02;
  const TempFolder folder;
  const std::string text = FingerToYaml(finger);
  EXPECT_THAT(text, HasSubstr("  friction_coefficient: 0.31\n"));
  const Finger back = ReadFinger(folder.Write("f.yaml", text));
  EXPECT_TRUE(back.calibration->HasFriction());
  EXPECT_EQ(back.calibration->friction, 0.31);
  EXPECT_EQ(FingerToYaml(back), text);

  // It is said about which coefficient.
  std::string without = text;
  without.erase(without.find("  friction_coefficient: 0.31\n"), 29);
  EXPECT_THROW(ReadFinger(folder.Write("g.yaml", without)), InputError);
}

TEST(ParameterCovarianceTest, FactorIsARoot) {
  ParameterCovariance covariance = *UncertainFinger().calibration;
  const Eigen::MatrixXd expected = covariance.std.asDiagonal() *
                                   covariance.correlations *
                                   covariance.std.asDiagonal();
  const Eigen::MatrixXd factor = covariance.Factor();
  EXPECT_LT((factor * factor.transpose() - expected).cwiseAbs().maxCoeff(),
            1e-12 * expected.cwiseAbs().maxCoeff());
  // An eigenvalue just below 0 counts as 0.
  covariance.std = Eigen::Vector2d(1, 1);
  covariance.correlations.setConstant(2, 2, 1.0000001);
  covariance.correlations.diagonal().setOnes();
  EXPECT_TRUE(covariance.Factor().allFinite());
}

TEST(ParameterCovarianceTest, NamesOfAllParameters) {
  const Finger finger = PaperFinger();
  const auto all = ParametersOf(finger);
  ASSERT_EQ(all.size(), 15u);
  EXPECT_EQ(ParameterName(all[0]), "front_stiffness_N_mm2");
  EXPECT_EQ(ParameterName(all[5]), "gauge_4_gain_V_per_rad");
  EXPECT_EQ(ParameterName(all[6]), "gauge_1_offset_V");
  EXPECT_EQ(ParameterName(all[14]), "rib_5_length_mm");
  Finger changed = finger;
  for (std::size_t i = 0; i < all.size(); ++i) {
    SetParameter(all[i], 100.0 + i, &changed);
  }
  EXPECT_EQ(changed.front_stiffness_N_mm2, 100);
  EXPECT_EQ(changed.back_stiffness_N_mm2, 101);
  EXPECT_EQ(changed.gauges[3].gain_V_per_rad, 105);
  EXPECT_EQ(changed.gauges[0].offset_V, 106);
  EXPECT_EQ(changed.ribs[4].length_mm, 114);
  EXPECT_EQ(ParameterValue(changed, all[14]), 114);
}

// A finger of one rib and one gauge with this block, which starts in line 11.
void ExpectThrow(const std::string& block, const std::string& message) {
  const TempFolder folder;
  const std::string path =
      folder.Write("f.yaml",
                   "schema_version: 1\nname: test\n"
                   "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
                   "beams:\n"
                   "  front: {bending_stiffness_N_mm2: 12500}\n"
                   "  back: {bending_stiffness_N_mm2: 12500}\n"
                   "ribs:\n  - {front_mm: 17, angle_deg: 10}\n"
                   "gauges:\n  - {beam: back, start_mm: 30, length_mm: 18}\n"
                   "calibration: {" +
                       block + "}\n");
  EXPECT_THAT([&] { ReadFinger(path); },
              ThrowsMessage<InputError>(HasSubstr(message)));
}

TEST(ParameterCovarianceTest, RefusesWhatIsNoCovariance) {
  ExpectThrow("parametres: [rib_1_length_mm], std: [1]",
              "f.yaml:11:15: unknown key 'parametres' in calibration (did you "
              "mean 'parameters'?)");
  ExpectThrow("std: [1]",
              "f.yaml:11:14: 'parameters' is missing in calibration");
  ExpectThrow("parameters: [], std: []",
              "f.yaml:11:27: parameters: expected at least one");
  ExpectThrow("parameters: [rib_1_lenght_mm], std: [1]",
              "f.yaml:11:28: parameters[1]: expected one of "
              "front_stiffness_N_mm2, back_stiffness_N_mm2, "
              "gauge_1_gain_V_per_rad, gauge_1_offset_V, rib_1_length_mm, "
              "gauge_1_curvature_per_rad, ");
  ExpectThrow("parameters: [rib_1_lenght_mm], std: [1]",
              "found 'rib_1_lenght_mm' (did you mean 'rib_1_length_mm'?)");
  ExpectThrow("parameters: [rib_2_length_mm], std: [1]",
              "found 'rib_2_length_mm' (did you mean 'rib_1_length_mm'?)");
  ExpectThrow("parameters: [object_origin_x_mm], std: [1]",
              "found 'object_origin_x_mm'");
  ExpectThrow("parameters: [gauge_1_offset_V, gauge_1_offset_V], std: [1, 1]",
              "f.yaml:11:46: parameters[2]: 'gauge_1_offset_V' appears twice");
  const std::string two = "parameters: [gauge_1_offset_V, rib_1_length_mm], ";
  ExpectThrow(two + "std: [1]",
              "f.yaml:11:69: std: expected 2 numbers, one a parameter, found "
              "1");
  ExpectThrow(two + "std: [1, -0.5]",
              "f.yaml:11:73: std[2]: expected a number of at least 0, found "
              "-0.5");
  ExpectThrow(two + "std: [1, .inf]",
              "f.yaml:11:73: std[2]: expected a number, found '.inf'");
  ExpectThrow(two + "std: 1",
              "f.yaml:11:69: std: expected a list of numbers, found '1'");
  const std::string std = two + "std: [1, 1], correlations: ";
  ExpectThrow(std + "1",
              "f.yaml:11:91: correlations: expected a list of rows, found '1'");
  ExpectThrow(std + "[[1]]",
              "f.yaml:11:91: correlations: expected 2 rows, one a parameter, "
              "found 1");
  ExpectThrow(std + "[1, [0, 1]]",
              "f.yaml:11:92: correlations[1]: expected a list of numbers, "
              "found '1'");
  ExpectThrow(std + "[[1], [1]]",
              "f.yaml:11:97: correlations[2]: expected 2 numbers, the lower "
              "triangle up to its 1, found 1");
  ExpectThrow(std + "[[1], [x, 1]]",
              "f.yaml:11:98: correlations[2][1]: expected a number, found "
              "'x'");
  ExpectThrow(std + "[[1], [-1.1, 1]]",
              "f.yaml:11:98: correlations[2][1]: expected a number from -1 to "
              "1, found -1.1");
  ExpectThrow(std + "[[1], [0.5, 0.9]]",
              "f.yaml:11:103: correlations[2][2]: expected 1 on the diagonal, "
              "found 0.9");
  ExpectThrow(
      "parameters: [gauge_1_offset_V, rib_1_length_mm, "
      "back_stiffness_N_mm2], std: [1, 1, 1], correlations: [[1], [0.9, 1], "
      "[0.9, -0.9, 1]]",
      "f.yaml:11:116: correlations: contradict each other: expected no "
      "eigenvalue below 0, found -0.8");
}

TEST(ParameterCovarianceTest, CorrelationsMayBeLeftOut) {
  const TempFolder folder;
  const Finger finger = ReadFinger(folder.Write(
      "f.yaml", FingerToYaml(PaperFinger()) +
                    "calibration:\n  parameters: [rib_1_length_mm, "
                    "rib_3_length_mm]\n  std: [0.1, 0]\n"));
  EXPECT_EQ(finger.calibration->correlations, Eigen::Matrix2d::Identity());
  EXPECT_EQ(finger.calibration->parameters[1].index, 2);
}

}  // namespace
}  // namespace finray

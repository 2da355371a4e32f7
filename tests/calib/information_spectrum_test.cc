#include "finray/calib/solve/information_spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace finray {
namespace {

// [a, b; b, c] has eigenvalues m +- sqrt(m^2 - det); the small one is
// det / the large one, without loss of digits.
TEST(InformationSpectrumTest, SmallEigenvalueBesideALargeOne) {
  Eigen::Matrix2d s;
  const double a = 3, c = 7e20, b = 0.3 * std::sqrt(a * c);
  s << a, b, b, c;
  const InformationSpectrum spectrum(s);
  const double mean = (a + c) / 2, det = (1 - 0.09) * a * c;
  const double large = mean + std::sqrt(mean * mean - det);
  EXPECT_NEAR(spectrum.values[1] / large, 1, 1e-14);
  EXPECT_NEAR(spectrum.values[0] / (det / large), 1, 1e-13);
  EXPECT_NEAR(std::abs(spectrum.vectors(0, 0)), 1, 1e-15);
  // S v = lambda v: the small component of that eigenvector is -b / c.
  EXPECT_NEAR(spectrum.vectors(1, 0) / spectrum.vectors(0, 0) / (-b / c), 1,
              1e-6);
}

// Units far apart, up to 1e12: S = D A D with A of condition 1e3. The inverse's
// diagonal is known from A alone.
TEST(InformationSpectrumTest, VariancesWhateverTheUnits) {
  const int n = 12;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd g(2 * n, n);
  for (double& value : g.reshaped()) value = normal(random);
  const Eigen::MatrixXd a = g.transpose() * g;
  const Eigen::MatrixXd inverse = a.inverse();
  Eigen::VectorXd d(n);
  for (int i = 0; i < n; ++i) d[i] = std::pow(10.0, (i * 5) % n);
  const InformationSpectrum spectrum(d.asDiagonal() * a * d.asDiagonal());
  EXPECT_TRUE(std::is_sorted(spectrum.values.begin(), spectrum.values.end()));
  EXPECT_LT((spectrum.vectors.transpose() * spectrum.vectors -
             Eigen::MatrixXd::Identity(n, n))
                .norm(),
            1e-13);
  const Eigen::MatrixXd covariance =
      spectrum.vectors * spectrum.values.cwiseInverse().asDiagonal() *
      spectrum.vectors.transpose();
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(covariance(i, i) * d[i] * d[i] / inverse(i, i), 1, 1e-9) << i;
  }
}

TEST(InformationSpectrumTest, NeitherOverflowsNorUnderflows) {
  const Eigen::Matrix2d s{{2, 1}, {1, 2}};  // 1 and 3
  for (const double scale : {1e-300, 1e-150, 1e150, 1e300}) {
    const InformationSpectrum spectrum(scale * s);
    EXPECT_NEAR(spectrum.values[0] / scale, 1, 1e-14) << scale;
    EXPECT_NEAR(spectrum.values[1] / scale, 3, 1e-14) << scale;
  }
}

TEST(InformationSpectrumTest, SingularAndEmpty) {
  Eigen::Matrix3d s;  // a sum alone, and nothing of the third
  s << 1e8, 1e8, 0, 1e8, 1e8, 0, 0, 0, 0;
  const InformationSpectrum spectrum(s);
  EXPECT_EQ(spectrum.values[0], 0);
  EXPECT_LT(spectrum.values[1], 1e-12);
  EXPECT_NEAR(spectrum.values[2] / 2e8, 1, 1e-14);
  EXPECT_LT((spectrum.vectors.transpose() * spectrum.vectors -
             Eigen::Matrix3d::Identity())
                .norm(),
            1e-14);
  EXPECT_EQ(DeterminedUnits(s, Eigen::Vector3d(1, 2, 3)).cols(), 1);
  EXPECT_EQ(InformationSpectrum(Eigen::MatrixXd::Zero(4, 4)).values.norm(), 0);
  EXPECT_EQ(InformationSpectrum(Eigen::MatrixXd(0, 0)).values.size(), 0);
}

TEST(InformationSpectrumTest, RefusesWhatIsNotFinite) {
  Eigen::Matrix2d s = Eigen::Matrix2d::Identity();
  s(0, 1) = s(1, 0) = std::nan("");
  EXPECT_THROW(InformationSpectrum{s}, std::runtime_error);
}

}  // namespace
}  // namespace finray

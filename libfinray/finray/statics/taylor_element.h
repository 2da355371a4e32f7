#ifndef FINRAY_STATICS_TAYLOR_ELEMENT_H_
#define FINRAY_STATICS_TAYLOR_ELEMENT_H_

#include <array>
#include <cmath>

#include "finray/statics/element.h"

namespace finray {

/// Taylor series of order K of the beam equation (element.h) in arc length.
///
/// With m = M / EI and n = N / EI the coefficients follow by recurrence:
///
///   theta_{k+1} = m_k / (k+1),        m_{k+1} = (n_x s_k - n_y c_k) / (k+1),
///   c_{k+1} = -sum_j m_j s_{k-j} / (k+1),   s_{k+1} = sum_j m_j c_{k-j} /
///   (k+1), x_{k+1} = c_k / (k+1),            y_{k+1} = s_k / (k+1),
///
/// and so do their derivatives by p in (m_0, n_x, n_y), because
/// dc/dp = -s dtheta/dp and ds/dp = c dtheta/dp hold between the series. The
/// derivative by theta_0 follows from turning the frame, the one by EI from the
/// shape depending on M / EI and N / EI only. The series is its own dense
/// output. The only trigonometric call is at the start.
template <int K>
class TaylorElement {
 public:
  void Compute(const ElementStart& start, double stiffness, double length) {
    start_ = start;
    stiffness_ = stiffness;
    const double m0 = start.moment_N_mm / stiffness;
    const double nx = start.force_x_N / stiffness;
    const double ny = start.force_y_N / stiffness;

    std::array<double, K + 1> c, s;
    c[0] = std::cos(start.theta_rad);
    s[0] = std::sin(start.theta_rad);
    theta_[0] = start.theta_rad;
    m_[0] = m0;
    x_[0] = y_[0] = 0;
    // Derivatives by p = m_0, n_x, n_y, innermost so that their sums overlap.
    Series3 dm, dx, dy;
    dtheta_[0] = dx[0] = dy[0] = {0, 0, 0};
    dm[0] = {1, 0, 0};
    for (int k = 0; k < K; ++k) {
      double ms = m_[0] * s[k], mc = m_[0] * c[k];
      double dc[3] = {0, 0, 0}, ds[3] = {0, 0, 0};
      for (int j = 1; j <= k; ++j) {
        const double sj = s[k - j], cj = c[k - j];
        ms += m_[j] * sj;
        mc += m_[j] * cj;
        for (int p = 0; p < 3; ++p) {
          dc[p] -= sj * dtheta_[j][p];
          ds[p] += cj * dtheta_[j][p];
        }
      }
      const double inverse = 1.0 / (k + 1);
      c[k + 1] = -ms * inverse;
      s[k + 1] = mc * inverse;
      theta_[k + 1] = m_[k] * inverse;
      m_[k + 1] = (nx * s[k] - ny * c[k]) * inverse;
      x_[k + 1] = c[k] * inverse;
      y_[k + 1] = s[k] * inverse;
      const double direct[3] = {0, s[k], -c[k]};
      for (int p = 0; p < 3; ++p) {
        dtheta_[k + 1][p] = dm[k][p] * inverse;
        dm[k + 1][p] = (nx * ds[p] - ny * dc[p] + direct[p]) * inverse;
        dx[k + 1][p] = dc[p] * inverse;
        dy[k + 1][p] = ds[p] * inverse;
      }
    }

    double* end = map_.end;
    end[0] = Evaluate(x_, length);
    end[1] = Evaluate(y_, length);
    end[2] = Evaluate(theta_, length);
    end[3] = stiffness * Evaluate(m_, length);
    map_.d_length[0] = Slope(x_, length);
    map_.d_length[1] = Slope(y_, length);
    map_.d_length[2] = Slope(theta_, length);
    map_.d_length[3] = stiffness * Slope(m_, length);
    const std::array<double, 3> by[4] = {
        Evaluate(dx, length), Evaluate(dy, length), Evaluate(dtheta_, length),
        Evaluate(dm, length)};
    for (int p = 0; p < 3; ++p) {
      // d/dM = (d/dm) / EI; for M itself the two EI cancel.
      for (int i = 0; i < 3; ++i) {
        map_.d_start[i][p + 1] = by[i][p] / stiffness;
      }
      map_.d_start[3][p + 1] = by[3][p];
    }
    const double turned[4] = {-end[1], end[0], 1, 0};
    const double scaled[4] = {0, 0, 0, end[3] / stiffness};
    for (int i = 0; i < 4; ++i) {
      map_.d_start[i][0] = turned[i] + ByTheta(map_.d_start[i]);
      map_.d_stiffness[i] = scaled[i] + ByStiffness(map_.d_start[i]);
    }
  }

  const ElementMap& map() const { return map_; }

  AngleReadout AngleAt(double offset) const {
    AngleReadout readout;
    readout.theta_rad = Evaluate(theta_, offset);
    const std::array<double, 3> by = Evaluate(dtheta_, offset);
    for (int p = 0; p < 3; ++p) readout.d_start[p + 1] = by[p] / stiffness_;
    readout.d_start[0] = 1 + ByTheta(readout.d_start);
    readout.d_stiffness = ByStiffness(readout.d_start);
    readout.d_offset = Slope(theta_, offset);
    readout.d_length = 0;
    return readout;
  }

  BeamPoint PointAt(double offset) const {
    return {Evaluate(x_, offset), Evaluate(y_, offset),
            Evaluate(theta_, offset), stiffness_ * Evaluate(m_, offset)};
  }

 private:
  using Series = std::array<double, K + 1>;
  using Series3 = std::array<std::array<double, 3>, K + 1>;

  static double Evaluate(const Series& a, double h) {
    double sum = a[K];
    for (int k = K - 1; k >= 0; --k) sum = sum * h + a[k];
    return sum;
  }
  static std::array<double, 3> Evaluate(const Series3& a, double h) {
    std::array<double, 3> sum = a[K];
    for (int k = K - 1; k >= 0; --k) {
      for (int p = 0; p < 3; ++p) sum[p] = sum[p] * h + a[k][p];
    }
    return sum;
  }
  static double Slope(const Series& a, double h) {
    double sum = K * a[K];
    for (int k = K - 1; k >= 1; --k) sum = sum * h + k * a[k];
    return sum;
  }
  // Turning the start by d is turning N by -d and the result by d.
  double ByTheta(const double* d) const {
    return d[2] * start_.force_y_N - d[3] * start_.force_x_N;
  }
  double ByStiffness(const double* d) const {
    return -(start_.moment_N_mm * d[1] + start_.force_x_N * d[2] +
             start_.force_y_N * d[3]) /
           stiffness_;
  }

  ElementStart start_;
  double stiffness_;
  Series theta_, m_, x_, y_;
  Series3 dtheta_;
  ElementMap map_;
};

}  // namespace finray

#endif  // FINRAY_STATICS_TAYLOR_ELEMENT_H_

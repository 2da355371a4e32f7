#ifndef FINRAY_LADDER_TAYLOR_ELEMENT_H_
#define FINRAY_LADDER_TAYLOR_ELEMENT_H_

#include <type_traits>

#include "finray/ladder/element.h"
#include "finray/ladder/lanes.h"

namespace finray {
inline namespace FINRAY_ISA {

/// The beam equation (element.h) by a Taylor series of order K in arc length.
/// With m = M / EI, n = N / EI and k = EI / EA the coefficients follow by
/// recurrence:
///
///   theta_{i+1} = m_i / (i+1),
///   m_{i+1} = (n_x Y_i - n_y X_i) / (i+1),
///   c_{i+1} = -sum_j m_j s_{i-j} / (i+1),
///   s_{i+1} = sum_j m_j c_{i-j} / (i+1),
///   x_{i+1} = X_i / (i+1),
///   y_{i+1} = Y_i / (i+1),
///
/// where (X, Y) = (c, s) + e (c, s), e = k (n_x c + n_y s). The term in e
/// exists only if the beam stretches. The derivatives by p in (m_0, n_x, n_y,
/// k) follow from the same recurrence, as dc/dp = -s dtheta/dp and ds/dp = c
/// dtheta/dp hold between the series. Turning the frame gives the derivative by
/// theta_0. The shape depends on M / EI, N / EI and EI / EA only, which gives
/// the derivative by EI. The moment follows from its balance, M + (r - r_0) x N
/// = M_0. The series is its own dense output; sin and cos are called at the
/// start only.
template <int K, class V = double, bool kStretch = false>
class TaylorElement {
 public:
  using Scalar = typename ValueTraits<V>::Scalar;

  void Solve(const BasicElementStart<V>& start, const V& stiffness,
             const V& axial_flexibility, const V& length) {
    Expand<false>(start, stiffness, axial_flexibility, length);
  }

  void SolveAndDifferentiate(const BasicElementStart<V>& start,
                             const V& stiffness, const V& axial_flexibility,
                             const V& length) {
    Expand<true>(start, stiffness, axial_flexibility, length);
    V by[3][kBy];
    Evaluate(dx_, length_, by[0]);
    Evaluate(dy_, length_, by[1]);
    Evaluate(dtheta_, length_, by[2]);
    for (int i = 0; i < 3; ++i) {
      // d/dM = (d/dm) / EI
      for (int p = 0; p < 3; ++p)
        map_.d_start[i][p + 1] = by[i][p] * flexibility_;
      if constexpr (kStretch) by_ratio_[i] = by[i][3];
    }
    map_.d_start[0][0] = ByTheta(map_.d_start[0]) - map_.end[1];
    map_.d_start[1][0] = ByTheta(map_.d_start[1]) + map_.end[0];
    map_.d_start[2][0] = ByTheta(map_.d_start[2]) + Scalar(1);
    for (int p = 0; p < 4; ++p) {
      map_.d_start[3][p] = start_.force_x_N * map_.d_start[1][p] -
                           start_.force_y_N * map_.d_start[0][p];
    }
    map_.d_start[3][1] += Scalar(1);
    map_.d_start[3][2] += map_.end[1];
    map_.d_start[3][3] -= map_.end[0];
  }

  void DifferentiateByStiffness() {
    for (int i = 0; i < 3; ++i) {
      map_.d_stiffness[i] = ByStiffness(map_.d_start[i]);
      if constexpr (kStretch) {
        map_.d_stiffness[i] += by_ratio_[i] * ratio_ * flexibility_;
      }
    }
    Balance(map_.d_stiffness);
  }

  void DifferentiateByLength() {
    map_.d_length[0] = Slope(x_, length_);
    map_.d_length[1] = Slope(y_, length_);
    map_.d_length[2] = Slope(theta_, length_);
    Balance(map_.d_length);
  }

  const BasicElementMap<V>& map() const { return map_; }

  BasicAngleReadout<V> AngleAt(const V& offset) const {
    BasicAngleReadout<V> readout;
    readout.theta_rad = Evaluate(theta_, offset);
    V by[kBy];
    Evaluate(dtheta_, offset, by);
    for (int p = 0; p < 3; ++p) readout.d_start[p + 1] = by[p] * flexibility_;
    readout.d_start[0] = ByTheta(readout.d_start) + Scalar(1);
    readout.d_stiffness = ByStiffness(readout.d_start);
    if constexpr (kStretch) {
      readout.d_stiffness += by[3] * ratio_ * flexibility_;
    }
    readout.d_offset = Slope(theta_, offset);
    readout.d_length = V{};
    return readout;
  }

  /// Coefficients of (x, y, theta, M) as polynomials of the offset.
  static constexpr int kDegree = K;
  void DenseOutput(V (*coefficients)[4]) const {
    for (int i = 0; i <= K; ++i) {
      coefficients[i][0] = x_[i];
      coefficients[i][1] = y_[i];
      coefficients[i][2] = theta_[i];
      coefficients[i][3] = stiffness_ * m_[i];
    }
  }

  /// The size of the last two terms of the angle's series.
  V Truncation() const {
    return Power<K - 1>(length_) *
           (Magnitude(theta_[K]) * length_ + Magnitude(theta_[K - 1]));
  }

 private:
  static constexpr int kBy = kStretch ? 4 : 3;  // m_0, n_x, n_y, EI / EA
  using Series = V[K + 1];
  using SeriesBy = V[K + 1][kBy];

  // Computes the series, and their derivatives in the same loops so that the
  // sums overlap.
  template <bool kDerivatives>
  void Expand(const BasicElementStart<V>& start, const V& stiffness,
              const V& axial_flexibility, const V& length) {
    start_ = start;
    stiffness_ = stiffness;
    length_ = length;
    flexibility_ = Scalar(1) / stiffness;
    nx_ = start.force_x_N * flexibility_;
    ny_ = start.force_y_N * flexibility_;
    SinCos(start.theta_rad, &s_[0], &c_[0]);
    theta_[0] = start.theta_rad;
    m_[0] = start.moment_N_mm * flexibility_;
    x_[0] = y_[0] = V{};
    if constexpr (kStretch) ratio_ = stiffness * axial_flexibility;
    V dm[kBy], de[kStretch ? K : 1][kBy], dc[kStretch ? K : 1][kBy],
        ds[kStretch ? K : 1][kBy];
    if constexpr (kDerivatives) {
      for (int p = 0; p < kBy; ++p) {
        dm[p] = V{};
      }
      dm[0] += Scalar(1);
    }
    // Adds term i + 1. After the last one no further term needs its c, s and
    // dm.
    const auto term = [&](int i, auto last) __attribute__((always_inline)) {
      constexpr bool kLast = decltype(last)::value;
      V ms = m_[0] * s_[i], mc = m_[0] * c_[i];
      V dci[kBy], dsi[kBy];
      for (int p = 0; p < kBy; ++p) dci[p] = dsi[p] = V{};
      if (i > 0) {
        // theta_1 = m_0
        const V sine = s_[i - 1], cosine = c_[i - 1];
        if constexpr (!kLast) {
          ms += m_[1] * sine;
          mc += m_[1] * cosine;
        }
        if constexpr (kDerivatives) {
          dci[0] -= sine;
          dsi[0] += cosine;
        }
      }
      for (int j = 2; j <= i; ++j) {
        const V sine = s_[i - j], cosine = c_[i - j];
        if constexpr (!kLast) {
          ms += m_[j] * sine;
          mc += m_[j] * cosine;
        }
        if constexpr (kDerivatives) {
          for (int p = 0; p < kBy; ++p) {
            dci[p] -= sine * dtheta_[j][p];
            dsi[p] += cosine * dtheta_[j][p];
          }
        }
      }
      V slope_x = c_[i], slope_y = s_[i];
      V d_slope_x[kBy], d_slope_y[kBy];
      for (int p = 0; p < kBy; ++p) {
        d_slope_x[p] = dci[p];
        d_slope_y[p] = dsi[p];
      }
      if constexpr (kStretch) {
        e_[i] = ratio_ * (nx_ * c_[i] + ny_ * s_[i]);
        for (int j = 0; j <= i; ++j) {
          slope_x += e_[j] * c_[i - j];
          slope_y += e_[j] * s_[i - j];
        }
        for (int p = 0; p < kBy; ++p) {
          dc[i][p] = dci[p];
          ds[i][p] = dsi[p];
          de[i][p] = ratio_ * (nx_ * dci[p] + ny_ * dsi[p]);
        }
        de[i][1] += ratio_ * c_[i];
        de[i][2] += ratio_ * s_[i];
        de[i][3] += nx_ * c_[i] + ny_ * s_[i];
        for (int j = 0; kDerivatives && j <= i; ++j) {
          for (int p = 0; p < kBy; ++p) {
            d_slope_x[p] += de[j][p] * c_[i - j] + e_[j] * dc[i - j][p];
            d_slope_y[p] += de[j][p] * s_[i - j] + e_[j] * ds[i - j][p];
          }
        }
      }
      const Scalar inverse = Scalar(1) / Scalar(i + 1);
      if constexpr (!kLast) {
        c_[i + 1] = -ms * inverse;
        s_[i + 1] = mc * inverse;
      }
      theta_[i + 1] = m_[i] * inverse;
      x_[i + 1] = slope_x * inverse;
      y_[i + 1] = slope_y * inverse;
      m_[i + 1] = nx_ * y_[i + 1] - ny_ * x_[i + 1];
      if constexpr (kDerivatives) {
        for (int p = 0; p < kBy; ++p) {
          dtheta_[i + 1][p] = dm[p] * inverse;
          dx_[i + 1][p] = d_slope_x[p] * inverse;
          dy_[i + 1][p] = d_slope_y[p] * inverse;
          if constexpr (!kLast) {
            dm[p] = nx_ * dy_[i + 1][p] - ny_ * dx_[i + 1][p];
          }
        }
        dm[1] += y_[i + 1];
        dm[2] -= x_[i + 1];
      }
    };
    for (int i = 0; i + 1 < K; ++i) term(i, std::false_type());
    term(K - 1, std::true_type());
    map_.end[0] = Evaluate(x_, length);
    map_.end[1] = Evaluate(y_, length);
    map_.end[2] = Evaluate(theta_, length);
    map_.end[3] = start.moment_N_mm + start.force_x_N * map_.end[1] -
                  start.force_y_N * map_.end[0];
  }

  template <int n>
  static V Power(const V& a) {
    if constexpr (n == 1) return a;
    if constexpr (n > 1 && n % 2 == 1) return a * Power<n - 1>(a);
    if constexpr (n > 1 && n % 2 == 0) return Power<n / 2>(V(a * a));
  }
  // The moment's derivative from those of the position.
  void Balance(V* d) const {
    d[3] = start_.force_x_N * d[1] - start_.force_y_N * d[0];
  }

  static V Evaluate(const Series& a, const V& h) {
    V sum = a[K];
    for (int i = K - 1; i >= 0; --i) sum = sum * h + a[i];
    return sum;
  }
  static void Evaluate(const SeriesBy& a, const V& h, V* sum) {
    for (int p = 0; p < kBy; ++p) sum[p] = a[K][p];
    for (int i = K - 1; i >= 1; --i) {
      for (int p = 0; p < kBy; ++p) sum[p] = sum[p] * h + a[i][p];
    }
    // The series of derivatives have no constant term.
    for (int p = 0; p < kBy; ++p) sum[p] *= h;
  }
  static V Slope(const Series& a, const V& h) {
    V sum = a[K] * Scalar(K);
    for (int i = K - 1; i >= 1; --i) sum = sum * h + a[i] * Scalar(i);
    return sum;
  }
  // The part of the derivative by theta_0 that comes through N: turning the
  // start by d is turning N by -d and the result by d.
  V ByTheta(const V* d) const {
    return d[2] * start_.force_y_N - d[3] * start_.force_x_N;
  }
  V ByStiffness(const V* d) const {
    return -(start_.moment_N_mm * d[1] + start_.force_x_N * d[2] +
             start_.force_y_N * d[3]) *
           flexibility_;
  }

  BasicElementStart<V> start_;
  V stiffness_, flexibility_, length_, nx_, ny_;
  Series c_, s_, theta_, m_, x_, y_;
  SeriesBy dtheta_, dx_, dy_;
  BasicElementMap<V> map_;
  // For a beam that stretches.
  struct Nothing {};
  std::conditional_t<kStretch, V, Nothing> ratio_;
  std::conditional_t<kStretch, V[K], Nothing> e_;
  std::conditional_t<kStretch, V[3], Nothing> by_ratio_;
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_TAYLOR_ELEMENT_H_

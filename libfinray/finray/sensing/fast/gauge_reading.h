#ifndef FINRAY_SENSING_FAST_GAUGE_READING_H_
#define FINRAY_SENSING_FAST_GAUGE_READING_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "finray/fit/contact_step.h"
#include "finray/ladder/contact_pose.h"
#include "finray/ladder/ladder_frame.h"

namespace finray {

/// The readings that ContactFit takes from the taps of a linearisation: the
/// gauges with their slopes by x (contact_step.h), and poses.
class GaugeReading {
 public:
  using Readings = Eigen::Ref<const Eigen::VectorXd>;

  explicit GaugeReading(int rows) : angle(rows) {
    slope.fill(angle);
    slope_before_.fill(angle);
  }

  /// Takes the gauges at the end of Newton's step. The readout maps hold the
  /// values before the step; the taps add the change that the step makes.
  void Read(const LadderFrame<double>& f, int unknowns) {
    slope.swap(slope_before_);
    std::fill(angle.begin(), angle.end(), 0.0);
    for (int k = 0; k < unknowns; ++k) {
      std::fill(slope[k].begin(), slope[k].end(), 0.0);
    }
    for (int i = 0; i < f.readout_count; ++i) {
      const int j = f.readouts[i].gauge;
      const double sign = f.readouts[i].sign;
      const double* tap = f.taps + f.readout_tap(i) * f.stride + f.affine;
      angle[j] += sign * (f.readout_map[kReadoutValues * i] + tap[0]);
      for (int k = 0; k < unknowns; ++k) slope[k][j] += sign * tap[1 + k];
    }
  }

  /// Moves the angles by the change of x.
  void Move(const ContactVector& change) {
    for (int k = 0; k < change.size(); ++k) {
      for (std::size_t j = 0; j < angle.size(); ++j) {
        angle[j] += slope[k][j] * change[k];
      }
    }
  }

  /// `weights` are 1 / std of `measured`.
  ContactEquations Equations(const Readings& measured, const Readings& weights,
                             int unknowns) const {
    return unknowns == 2 ? Sums<2>(measured, weights)
                         : Sums<kMost>(measured, weights);
  }

  double Chi2(const Readings& measured, const Readings& weights) const {
    double chi2 = 0;
    for (std::size_t j = 0; j < angle.size(); ++j) {
      const double residual = weights[j] * (angle[j] - measured[j]);
      chi2 += residual * residual;
    }
    return chi2;
  }

  /// CurvatureRate for the `step` between the last two calls of Read.
  double Rate(const Readings& measured, const Readings& weights,
              const ContactEquations& equations, double damping,
              const ContactVector& step, const ContactVector& x) const {
    ContactVector by_residual(x.size());
    for (int k = 0; k < x.size(); ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < angle.size(); ++j) {
        sum += weights[j] * weights[j] * (angle[j] - measured[j]) *
               (slope[k][j] - slope_before_[k][j]);
      }
      by_residual[k] = sum;
    }
    return CurvatureRate(equations, damping, by_residual, step, x);
  }

  static constexpr int kMost = 2 * kFittedContacts;

  std::vector<double> angle;
  std::array<std::vector<double>, kMost> slope;

 private:
  template <int kUnknowns>
  ContactEquations Sums(const Readings& measured,
                        const Readings& weights) const {
    double normal[kUnknowns][kUnknowns] = {}, gradient[kUnknowns] = {};
    double chi2 = 0;
    for (std::size_t j = 0; j < angle.size(); ++j) {
      const double residual = weights[j] * (angle[j] - measured[j]);
      chi2 += residual * residual;
      double by[kUnknowns];
      for (int k = 0; k < kUnknowns; ++k) {
        by[k] = weights[j] * slope[k][j];
        gradient[k] += by[k] * residual;
        for (int l = 0; l <= k; ++l) normal[k][l] += by[k] * by[l];
      }
    }
    ContactEquations equations{ContactMatrix(kUnknowns, kUnknowns),
                               ContactVector(kUnknowns), chi2};
    for (int k = 0; k < kUnknowns; ++k) {
      equations.gradient[k] = gradient[k];
      for (int l = 0; l <= k; ++l) {
        equations.normal(k, l) = equations.normal(l, k) = normal[k][l];
      }
    }
    return equations;
  }

  std::array<std::vector<double>, kMost> slope_before_;
};

/// The change of a value in Newton's step and `change` of x. `row` is the
/// value's row of taps.
inline double ChangeOf(const LadderFrame<double>& f, const double* row,
                       const ContactVector& change) {
  row += f.affine;
  double sum = row[0];
  for (int k = 0; k < change.size(); ++k) sum += row[1 + k] * change[k];
  return sum;
}

/// (x, y, theta) of contact `c` of the frame, or of the tip if there is no such
/// contact, after that step and change; x and y in mm.
inline Eigen::Vector3d PoseAfter(const LadderFrame<double>& f, int c,
                                 double length_unit,
                                 const ContactVector& change) {
  const bool tip = c == f.contact_count;
  const int tap = tip ? f.tip_tap() : f.contact_tap(f.contacts[c].index);
  Eigen::Vector3d pose =
      tip ? Eigen::Vector3d(f.tip[0], f.tip[1], f.tip[2]) : ContactPose(f, c);
  for (int i = 0; i < 3; ++i) {
    pose[i] += ChangeOf(f, f.taps + (tap + i) * f.stride, change);
  }
  pose.head<2>() *= length_unit;
  return pose;
}

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_GAUGE_READING_H_

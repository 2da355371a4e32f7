#ifndef FINRAY_SENSING_FAST_GAUGE_READING_H_
#define FINRAY_SENSING_FAST_GAUGE_READING_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "finray/ladder/contact_pose.h"
#include "finray/ladder/ladder_frame.h"
#include "finray/ladder/lanes.h"
#include "finray/sensing/fast/contact_step.h"

namespace finray {

/// The readings that ContactFit and FrameGroupFit take from the taps of a
/// linearisation: the gauges with their slopes by at most kMost entries of x
/// (contact_step.h), and poses. T is double for one frame (lane 0) or
/// FourFrames for one frame a lane.
template <class T, int kMost>
class GaugeReading {
 public:
  using Readings = Eigen::Ref<const Eigen::VectorXd>;

  explicit GaugeReading(int rows) : angle(rows) {
    slope.fill(angle);
    slope_before_.fill(angle);
  }

  /// Takes the gauges at the end of Newton's step. The readout maps hold the
  /// values before the step; the taps add the change that the step makes.
  void Read(const LadderFrame<T>& f, int unknowns) {
    slope.swap(slope_before_);
    std::fill(angle.begin(), angle.end(), T{});
    for (int k = 0; k < unknowns; ++k) {
      std::fill(slope[k].begin(), slope[k].end(), T{});
    }
    for (int i = 0; i < f.readout_count; ++i) {
      const int j = f.readouts[i].gauge;
      const double sign = f.readouts[i].sign;
      const T* tap = f.taps + f.readout_tap(i) * f.stride + f.affine;
      angle[j] += sign * (f.readout_map[kReadoutValues * i] + tap[0]);
      for (int k = 0; k < unknowns; ++k) slope[k][j] += sign * tap[1 + k];
    }
  }

  /// Moves the angles by the change of x.
  void Move(const ContactVector& change, int lane) {
    for (int k = 0; k < change.size(); ++k) {
      for (std::size_t j = 0; j < angle.size(); ++j) {
        LaneOf(angle[j], lane) += LaneOf(slope[k][j], lane) * change[k];
      }
    }
  }

  /// `weights` are 1 / std of `measured`. With `curvatures`, of one contact,
  /// the equations have B.
  ContactEquations Equations(const Readings& measured, const Readings& weights,
                             const GaugeCurvatures* curvatures, int unknowns,
                             int lane) const {
    if (curvatures != nullptr) {
      return After(measured, weights, *curvatures, 0, 0, lane);
    }
    return unknowns == 2 ? Sums<2>(measured, weights, lane)
                         : Sums<kMost>(measured, weights, lane);
  }

  /// BoundedChange of `equations`, and where they have B, a second one from
  /// there by the quadratic of After: what is left is of third order. The
  /// second one is left out if the first is damped or if it does not shrink:
  /// the quadratic then says little. Both together keep to kLongestMove.
  ContactVector Change(const Readings& measured, const Readings& weights,
                       const GaugeCurvatures* curvatures,
                       const ContactEquations& equations,
                       const ContactVector& x, double most_force,
                       double damping, int lane) const {
    const ContactVector change =
        BoundedChange(equations, x, most_force, damping);
    if (equations.curvature.size() == 0 || damping > 0) return change;
    const ContactEquations there =
        After(measured, weights, *curvatures, change[0], change[1], lane);
    if (there.curvature.size() == 0) return change;
    const ContactVector second =
        BoundedChange(there, x + change, most_force, 0);
    const bool shrinks =
        LargestChange(second, x, 0) < LargestChange(change, x, 0);
    if (!shrinks || std::abs(change[0] + second[0]) > kLongestMove) {
      return change;
    }
    return change + second;
  }

  double Chi2(const Readings& measured, const Readings& weights,
              int lane) const {
    double chi2 = 0;
    for (std::size_t j = 0; j < angle.size(); ++j) {
      const double residual =
          weights[j] * (LaneOf(angle[j], lane) - measured[j]);
      chi2 += residual * residual;
    }
    return chi2;
  }

  /// CurvatureRate for the `step` between the last two calls of Read.
  double Rate(const Readings& measured, const Readings& weights,
              const ContactEquations& equations, double damping,
              const ContactVector& step, const ContactVector& x,
              int lane) const {
    ContactVector by_residual(x.size());
    for (int k = 0; k < x.size(); ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < angle.size(); ++j) {
        sum += weights[j] * weights[j] *
               (LaneOf(angle[j], lane) - measured[j]) *
               (LaneOf(slope[k][j], lane) - LaneOf(slope_before_[k][j], lane));
      }
      by_residual[k] = sum;
    }
    return CurvatureRate(equations, damping, by_residual, step, x);
  }

  std::vector<T> angle;
  std::array<std::vector<T>, kMost> slope;

 private:
  // The equations of one contact with B, after a change (dl, df) of x, by
  //
  //   s_j(x + dx) = s_j + S_j dx + dx' H_j dx / 2.
  ContactEquations After(const Readings& measured, const Readings& weights,
                         const GaugeCurvatures& curvatures, double dl,
                         double df, int lane) const {
    CurvedSums sums;
    for (std::size_t j = 0; j < angle.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      const double ll = curvatures(row, 0), lf = curvatures(row, 1),
                   ff = curvatures(row, 2);
      const double rise_l = ll * dl + lf * df, rise_f = lf * dl + ff * df;
      const double slope_l = LaneOf(slope[0][j], lane),
                   slope_f = LaneOf(slope[1][j], lane);
      sums.Add(weights[row],
               LaneOf(angle[j], lane) - measured[row] +
                   (slope_l + rise_l / 2) * dl + (slope_f + rise_f / 2) * df,
               slope_l + rise_l, slope_f + rise_f, ll, lf, ff);
    }
    return sums.Equations();
  }

  template <int kUnknowns>
  ContactEquations Sums(const Readings& measured, const Readings& weights,
                        int lane) const {
    double normal[kUnknowns][kUnknowns] = {}, gradient[kUnknowns] = {};
    double chi2 = 0;
    for (std::size_t j = 0; j < angle.size(); ++j) {
      const double residual =
          weights[j] * (LaneOf(angle[j], lane) - measured[j]);
      chi2 += residual * residual;
      double by[kUnknowns];
      for (int k = 0; k < kUnknowns; ++k) {
        by[k] = weights[j] * LaneOf(slope[k][j], lane);
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

  std::array<std::vector<T>, kMost> slope_before_;
};

/// The change of a value in Newton's step and `change` of x. `row` is the
/// value's row of taps or q_step.
template <class T>
double ChangeOf(const LadderFrame<T>& f, const T* row,
                const ContactVector& change, int lane) {
  row += f.affine;
  double sum = LaneOf(row[0], lane);
  for (int k = 0; k < change.size(); ++k) {
    sum += LaneOf(row[1 + k], lane) * change[k];
  }
  return sum;
}

/// (x, y, theta) of contact `c` of the frame, or of the tip if there is no such
/// contact, after that step and change; x and y in mm.
template <class T>
Eigen::Vector3d PoseAfter(const LadderFrame<T>& f, int c, double length_unit,
                          const ContactVector& change, int lane) {
  const bool tip = c == f.contact_count;
  const int tap = tip ? f.tip_tap() : f.contact_tap(f.contacts[c].index);
  Eigen::Vector3d pose =
      tip ? Eigen::Vector3d(LaneOf(f.tip[0], lane), LaneOf(f.tip[1], lane),
                            LaneOf(f.tip[2], lane))
          : ContactPose(f, c, lane);
  for (int i = 0; i < 3; ++i) {
    pose[i] += ChangeOf(f, f.taps + (tap + i) * f.stride, change, lane);
  }
  pose.head<2>() *= length_unit;
  return pose;
}

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_GAUGE_READING_H_

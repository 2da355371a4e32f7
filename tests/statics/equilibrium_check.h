#ifndef FINRAY_TESTS_STATICS_EQUILIBRIUM_CHECK_H_
#define FINRAY_TESTS_STATICS_EQUILIBRIUM_CHECK_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"

namespace finray {

/// A solved finger held against the beam equation by an integrator of its own
/// (Gragg's, extrapolated to order 12): between two stations of a shape it is
/// integrated anew from the section at the first and compared with the one at
/// the second, so that no error grows along a beam. Internal forces are not
/// read from the shape: they are base reactions less contacts and ribs.
class EquilibriumCheck {
 public:
  EquilibriumCheck(const EquilibriumSolver& solver,
                   const std::vector<PointContact>& contacts)
      : finger_(solver.model().finger()), shape_(solver, contacts) {
    length_ = finger_.front_length_mm;
    // Loads below those that bend the finger by 1e-3 rad count as such.
    force_ = 1e-3 *
             std::min(BendingStiffness(solver.model().finger(), Side::kFront),
                      BendingStiffness(solver.model().finger(), Side::kBack)) /
             (length_ * length_);
    for (const PointContact& contact : contacts) {
      force_ = std::max(force_, std::abs(contact.normal_N));
    }
    for (int i = 0; i < solver.model().ribs(); ++i) {
      force_ = std::max(force_, std::abs(solver.rib_tension(i)));
    }
    Eigen::Vector3d outside = Eigen::Vector3d::Zero();
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Eigen::Vector3d reaction = BaseReaction(solver, side);
      const double base = shape_.At(side, 0).x_mm;
      outside += reaction;
      outside[0] += base * reaction[2];
      March(solver, contacts, side, &outside);
    }
    CheckRibs(solver);
    CheckTip(solver);
    Worst(std::abs(outside[0]) / (force_ * length_), "moments on the finger");
    Worst(outside.tail<2>().norm() / force_, "forces on the finger");
  }

  /// The largest violation: positions and rib lengths over l_0, angles in rad,
  /// forces over the largest force, moments over that by l_0. NaN if anything
  /// is.
  double worst() const { return worst_; }
  const std::string& what() const { return what_; }

 private:
  using Long = long double;
  using State = std::array<Long, 4>;  // x, y, theta, M
  struct Beam {
    Long force_x, force_y, stiffness, axial_stiffness;
  };

  static State Slope(const State& at, const Beam& beam) {
    const Long c = std::cos(at[2]), s = std::sin(at[2]);
    const Long stretch =
        1 + (c * beam.force_x + s * beam.force_y) / beam.axial_stiffness;
    return {stretch * c, stretch * s, at[3] / beam.stiffness,
            stretch * (beam.force_x * s - beam.force_y * c)};
  }

  static State Integrate(const State& start, const Beam& beam, Long length) {
    constexpr int kRows = 6;
    std::array<State, kRows> row;
    for (int k = 0; k < kRows; ++k) {
      const int steps = 2 * (k + 1);
      const Long h = length / steps;
      State before = start, at = start;
      State slope = Slope(start, beam);
      for (int i = 0; i < 4; ++i) at[i] += h * slope[i];
      for (int step = 1; step < steps; ++step) {
        slope = Slope(at, beam);
        for (int i = 0; i < 4; ++i) {
          const Long next = before[i] + 2 * h * slope[i];
          before[i] = at[i];
          at[i] = next;
        }
      }
      slope = Slope(at, beam);
      for (int i = 0; i < 4; ++i) {
        row[k][i] = (before[i] + at[i] + h * slope[i]) / 2;
      }
      for (int j = k - 1; j >= 0; --j) {
        const Long ratio = static_cast<Long>(k + 1) / (j + 1);
        for (int i = 0; i < 4; ++i) {
          row[j][i] =
              row[j + 1][i] + (row[j + 1][i] - row[j][i]) / (ratio * ratio - 1);
        }
      }
    }
    return row[0];
  }

  void Worst(double error, const std::string& what) {
    // Written so that a NaN gets in and stays.
    if (!(error <= worst_) && !std::isnan(worst_)) {
      worst_ = error;
      what_ = what;
    }
  }

  Eigen::Vector2d Hinge(Side side, int rib) const {
    const Section at =
        shape_.At(side, side == Side::kFront ? finger_.ribs[rib].front_mm
                                             : finger_.ribs[rib].back_mm);
    return {at.x_mm, at.y_mm};
  }

  static double StiffnessRatio(const std::vector<StiffnessPiece>& pieces,
                               double arc_mm) {
    for (const StiffnessPiece& piece : pieces) {
      if (arc_mm < piece.end_mm) return piece.stiffness_ratio;
    }
    return 1;
  }

  void March(const EquilibriumSolver& solver,
             const std::vector<PointContact>& contacts, Side side,
             Eigen::Vector3d* outside) {
    const bool front = side == Side::kFront;
    const std::string name = front ? "front" : "back";
    const Eigen::Vector3d reaction = BaseReaction(solver, side);
    // Loads at their arc lengths, as external forces on this beam.
    struct Load {
      double arc;
      Eigen::Vector2d force;
    };
    std::vector<Load> loads;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (contacts[i].side != side) continue;
      const Eigen::Vector3d pose = solver.contact_pose(static_cast<int>(i));
      const double c = std::cos(pose.z()), s = std::sin(pose.z());
      const Eigen::Vector2d normal =
          front ? Eigen::Vector2d(s, -c) : Eigen::Vector2d(-s, c);
      const Eigen::Vector2d force =
          contacts[i].normal_N *
          (normal + contacts[i].friction * Eigen::Vector2d(c, s));
      loads.push_back({contacts[i].arc_mm, force});
      outside->tail<2>() += force;
      (*outside)[0] += pose.x() * force.y() - pose.y() * force.x();
      const Section at = shape_.At(side, contacts[i].arc_mm);
      Worst(std::hypot(at.x_mm - pose.x(), at.y_mm - pose.y()) / length_,
            "place of a contact");
      Worst(std::abs(at.theta_rad - pose.z()), "angle of a contact");
    }
    for (int i = 0; i < solver.model().ribs(); ++i) {
      const Eigen::Vector2d pull =
          solver.rib_tension(i) *
          (Hinge(Side::kBack, i) - Hinge(Side::kFront, i)).normalized();
      loads.push_back(
          {front ? finger_.ribs[i].front_mm : finger_.ribs[i].back_mm,
           front ? pull : Eigen::Vector2d(-pull)});
    }
    const std::vector<double> stations = Stations(solver, contacts, side);
    const Section base = shape_.At(side, 0);
    Worst(std::abs(base.moment_N_mm + reaction[0]) / (force_ * length_),
          name + " moment at the base");
    const double angle = front ? M_PI / 2 : finger_.back_angle_rad;
    Worst(std::abs(base.theta_rad - angle), name + " angle at the base");
    const double base_x =
        front ? 0 : -length_ / std::tan(finger_.back_angle_rad);
    Worst(std::hypot(base.x_mm - base_x, base.y_mm) / length_,
          name + " place of the base");
    for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
      Eigen::Vector2d force = -reaction.tail<2>();
      // Loads sit at stations; half an interval further they are passed.
      const double middle = (stations[k] + stations[k + 1]) / 2;
      for (const Load& load : loads) {
        if (load.arc < middle) force -= load.force;
      }
      const double step = stations[k + 1] - stations[k];
      if (step < 1e-9 * length_) continue;
      const Section from = shape_.At(side, stations[k]);
      const Beam beam{
          force.x(), force.y(),
          BendingStiffness(solver.model().finger(), side) *
              StiffnessRatio(front ? finger_.front_pieces : finger_.back_pieces,
                             middle),
          front ? finger_.front_axial_stiffness_N
                : finger_.back_axial_stiffness_N};
      const State end = Integrate(
          {from.x_mm, from.y_mm, from.theta_rad, from.moment_N_mm}, beam, step);
      const Section to = shape_.At(side, stations[k + 1]);
      Worst(static_cast<double>(std::hypot(end[0] - to.x_mm, end[1] - to.y_mm) /
                                length_),
            name + " place");
      Worst(static_cast<double>(std::abs(end[2] - to.theta_rad)),
            name + " angle");
      Worst(static_cast<double>(std::abs(end[3] - to.moment_N_mm)) /
                (force_ * length_),
            name + " moment");
    }
    tip_force_ -= reaction.tail<2>();
    for (const Load& load : loads) tip_force_ -= load.force;
    tip_moment_ += shape_.At(side, stations.back()).moment_N_mm;
  }

  void CheckRibs(const EquilibriumSolver& solver) {
    for (int i = 0; i < solver.model().ribs(); ++i) {
      const Rib& rib = finger_.ribs[i];
      const double length =
          (Hinge(Side::kBack, i) - Hinge(Side::kFront, i)).norm();
      const double stretched =
          rib.length_mm * (1 + solver.rib_tension(i) / rib.axial_stiffness_N);
      Worst(std::abs(length - stretched) / length_, "rib length");
    }
  }

  void CheckTip(const EquilibriumSolver& solver) {
    const Section front = shape_.At(Side::kFront, length_);
    const Section back =
        shape_.At(Side::kBack, BeamLength(finger_, Side::kBack));
    Worst(std::hypot(front.x_mm - back.x_mm, front.y_mm - back.y_mm) / length_,
          "tip closure");
    Worst(std::abs(front.theta_rad - back.theta_rad - M_PI / 2 +
                   finger_.back_angle_rad),
          "tip angle");
    Worst(tip_force_.norm() / force_, "forces at the tip");
    Worst(std::abs(tip_moment_) / (force_ * length_), "moments at the tip");
    const Eigen::Vector3d pose = solver.tip_pose();
    Worst(std::hypot(front.x_mm - pose.x(), front.y_mm - pose.y()) / length_,
          "tip pose");
  }

  const Finger& finger_;
  Shape shape_;
  double length_ = 0, force_ = 0;
  Eigen::Vector2d tip_force_ = Eigen::Vector2d::Zero();
  double tip_moment_ = 0;
  double worst_ = 0;
  std::string what_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_EQUILIBRIUM_CHECK_H_

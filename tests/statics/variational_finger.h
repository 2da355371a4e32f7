#ifndef FINRAY_TESTS_STATICS_VARIATIONAL_FINGER_H_
#define FINRAY_TESTS_STATICS_VARIATIONAL_FINGER_H_

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/ladder/ladder.h"
#include "statics/gauss_legendre.h"

namespace finray {

/// The finger by another formulation, for comparison: no internal forces, no
/// marching. The curvature of each smooth piece of a beam is a Legendre series
/// with coefficients a; virtual work gives (springs of hinges add k a^2 / 2)
///
///   d/da sum (integral EI kappa^2 / 2) - F_c . dr_c/da + lambda . dg/da = 0,
///   g = [|r_R - r_L| - L - lambda L / EA of each rib; x, y, theta at the tip]
///
/// whose multipliers lambda are the rib tensions and the wrench in the tip.
/// Newton with a Jacobian by differences, along a ramp of the loads.
class VariationalFinger {
 public:
  VariationalFinger(const Finger& finger,
                    const std::vector<PointContact>& contacts)
      : finger_(finger), contacts_(contacts) {
    const double back_length =
        finger.front_length_mm / std::sin(finger.back_angle_rad);
    for (int side = 0; side < 2; ++side) {
      Beam& beam = beams_[side];
      beam.stiffness = side == 0 ? finger.front_stiffness_N_mm2
                                 : finger.back_stiffness_N_mm2;
      beam.angle = side == 0 ? M_PI / 2 : finger.back_angle_rad;
      beam.base = {
          side == 0 ? 0
                    : -finger.front_length_mm / std::tan(finger.back_angle_rad),
          0};
      beam.breaks = {0, side == 0 ? finger.front_length_mm : back_length};
      for (const Rib& rib : finger.ribs) {
        beam.breaks.push_back(side == 0 ? rib.front_mm : rib.back_mm);
      }
      for (const Gauge& gauge : finger.gauges) {
        if ((gauge.beam == Side::kFront) != (side == 0)) continue;
        beam.breaks.push_back(gauge.start_mm);
        beam.breaks.push_back(gauge.start_mm + gauge.length_mm);
      }
      for (const PointContact& contact : contacts) {
        if (side == 0) beam.breaks.push_back(contact.arc_mm);
      }
      std::sort(beam.breaks.begin(), beam.breaks.end());
      beam.breaks.erase(std::unique(beam.breaks.begin(), beam.breaks.end()),
                        beam.breaks.end());
      beam.first_dof = dofs_;
      dofs_ += kBasis * (static_cast<int>(beam.breaks.size()) - 1);
    }
    size_ = dofs_ + static_cast<int>(finger.ribs.size()) + 3;
  }

  /// False if Newton failed.
  bool Solve() {
    unknowns_.setZero(size_);
    constexpr int kRamp = 4;
    for (int i = 1; i <= kRamp; ++i) {
      if (!SolveAt(static_cast<double>(i) / kRamp)) return false;
    }
    return true;
  }

  double tension(int rib) const { return unknowns_[dofs_ + rib]; }
  Eigen::Vector3d tip() const { return PoseAt(0, finger_.front_length_mm); }
  Eigen::Vector3d contact(int i) const {
    return PoseAt(0, contacts_[i].arc_mm);
  }
  double gauge(int j) const {
    const Gauge& gauge = finger_.gauges[j];
    const int side = gauge.beam == Side::kFront ? 0 : 1;
    return PoseAt(side, gauge.start_mm + gauge.length_mm).z() -
           PoseAt(side, gauge.start_mm).z();
  }

 private:
  static constexpr int kBasis = 8;
  static constexpr int kPoints = 12;

  // Integrals of the Legendre basis from 0 to a quadrature point of [0, 1].
  struct BasisPoint {
    double weight;
    std::array<double, kBasis> turn;
  };
  static std::vector<BasisPoint> MakeBasis() {
    std::vector<BasisPoint> basis;
    for (const QuadraturePoint& q : GaussLegendre(kPoints, 0, 1)) {
      const std::vector<double> p = Legendre(kBasis, 2 * q.at - 1);
      BasisPoint point{q.weight, {q.at}};
      for (int j = 1; j < kBasis; ++j) {
        point.turn[j] = (p[j + 1] - p[j - 1]) / (2 * (2 * j + 1));
      }
      basis.push_back(point);
    }
    return basis;
  }

  struct Beam {
    double stiffness, angle;
    Eigen::Vector2d base;
    std::vector<double> breaks;
    int first_dof;
    std::vector<Eigen::Vector3d> pose;    // at the breaks
    std::vector<Eigen::MatrixXd> d_pose;  // by all dofs
  };

  int BreakAt(const Beam& beam, double arc) const {
    return static_cast<int>(
        std::find(beam.breaks.begin(), beam.breaks.end(), arc) -
        beam.breaks.begin());
  }
  Eigen::Vector3d PoseAt(int side, double arc) const {
    return beams_[side].pose[BreakAt(beams_[side], arc)];
  }

  // Poses at the breaks, their derivatives and d(energy)/da.
  void Trace(const Eigen::VectorXd& z, Eigen::VectorXd* d_energy) {
    d_energy->setZero(dofs_);
    for (Beam& beam : beams_) {
      const int pieces = static_cast<int>(beam.breaks.size()) - 1;
      beam.pose.assign(pieces + 1, Eigen::Vector3d::Zero());
      beam.d_pose.assign(pieces + 1, Eigen::MatrixXd::Zero(3, dofs_));
      beam.pose[0] << beam.base, beam.angle;
      for (int k = 0; k < pieces; ++k) {
        const double h = beam.breaks[k + 1] - beam.breaks[k];
        const int dof = beam.first_dof + kBasis * k;
        Eigen::Vector2d along(0, 0);
        Eigen::Matrix<double, 2, kBasis> local;
        local.setZero();
        for (const BasisPoint& q : basis_) {
          double theta = beam.pose[k].z();
          double turn[kBasis];
          for (int j = 0; j < kBasis; ++j) {
            turn[j] = h * q.turn[j];
            theta += z[dof + j] * turn[j];
          }
          const double w = q.weight * h;
          along += w * Eigen::Vector2d(std::cos(theta), std::sin(theta));
          for (int j = 0; j < kBasis; ++j) {
            local.col(j) += w * turn[j] *
                            Eigen::Vector2d(-std::sin(theta), std::cos(theta));
          }
        }
        beam.pose[k + 1] = beam.pose[k];
        beam.pose[k + 1].head<2>() += along;
        beam.pose[k + 1].z() += h * z[dof];
        Eigen::MatrixXd& d = beam.d_pose[k + 1];
        d = beam.d_pose[k];
        d.row(0) -= along.y() * beam.d_pose[k].row(2);
        d.row(1) += along.x() * beam.d_pose[k].row(2);
        d.block(0, dof, 2, kBasis) += local;
        d(2, dof) += h;
        for (int j = 0; j < kBasis; ++j) {
          (*d_energy)[dof + j] += beam.stiffness * h * z[dof + j] / (2 * j + 1);
        }
      }
    }
  }

  // The derivative of k_F a_F^2 / 2 + k_B a_B^2 / 2.
  Eigen::VectorXd SpringWork(const Rib& rib, int front, int back,
                             const Eigen::Vector2d& u, double length) const {
    const Eigen::Vector2d rest =
        UndeformedPoint(finger_, Side::kBack, rib.back_mm) -
        UndeformedPoint(finger_, Side::kFront, rib.front_mm);
    const double swing =
        std::atan2(rest.x() * u.y() - rest.y() * u.x(), rest.dot(u));
    const Eigen::RowVectorXd d_swing =
        Eigen::RowVector2d(-u.y(), u.x()) / length *
        (beams_[1].d_pose[back] - beams_[0].d_pose[front]).topRows<2>();
    Eigen::VectorXd work = Eigen::VectorXd::Zero(dofs_);
    for (int side = 0; side < 2; ++side) {
      const int at = side == 0 ? front : back;
      const double k = side == 0 ? rib.front_hinge_N_mm_per_rad
                                 : rib.back_hinge_N_mm_per_rad;
      work += k * (beams_[side].pose[at].z() - beams_[side].angle - swing) *
              (beams_[side].d_pose[at].row(2) - d_swing).transpose();
    }
    return work;
  }

  Eigen::VectorXd Residual(const Eigen::VectorXd& z, double fraction) {
    Eigen::VectorXd work;
    Trace(z, &work);
    Eigen::VectorXd residual(size_);
    for (const PointContact& contact : contacts_) {
      const int at = BreakAt(beams_[0], contact.arc_mm);
      const double theta = beams_[0].pose[at].z();
      const double c = std::cos(theta), s = std::sin(theta);
      const Eigen::Vector2d force =
          fraction * contact.normal_N *
          (Eigen::Vector2d(s, -c) + contact.friction * Eigen::Vector2d(c, s));
      work -= beams_[0].d_pose[at].topRows<2>().transpose() * force;
    }
    int row = dofs_;
    for (const Rib& rib : finger_.ribs) {
      const int front = BreakAt(beams_[0], rib.front_mm);
      const int back = BreakAt(beams_[1], rib.back_mm);
      const Eigen::Vector2d across =
          (beams_[1].pose[back] - beams_[0].pose[front]).head<2>();
      const double length = across.norm();
      residual[row] = length - rib.length_mm -
                      z[row] * rib.length_mm / rib.axial_stiffness_N;
      work += z[row] / length *
              (beams_[1].d_pose[back] - beams_[0].d_pose[front])
                  .topRows<2>()
                  .transpose() *
              across;
      work += SpringWork(rib, front, back, across / length, length);
      ++row;
    }
    Eigen::Vector3d gap = beams_[0].pose.back() - beams_[1].pose.back();
    gap.z() -= M_PI / 2 - finger_.back_angle_rad;
    residual.tail<3>() = gap;
    work += (beams_[0].d_pose.back() - beams_[1].d_pose.back()).transpose() *
            z.tail<3>();
    residual.head(dofs_) = work;
    return residual;
  }

  bool SolveAt(double fraction) {
    Eigen::VectorXd scale(size_);
    scale.head(dofs_).setConstant(1e-2);  // rad/mm
    scale.tail(size_ - dofs_).setOnes();  // N
    for (int i = 0; i < 20; ++i) {
      const Eigen::VectorXd residual = Residual(unknowns_, fraction);
      Eigen::MatrixXd jacobian(size_, size_);
      for (int j = 0; j < size_; ++j) {
        Eigen::VectorXd up = unknowns_, down = unknowns_;
        up[j] += 1e-4 * scale[j];
        down[j] -= 1e-4 * scale[j];
        jacobian.col(j) =
            (Residual(up, fraction) - Residual(down, fraction)) / 2e-4;
      }
      const Eigen::VectorXd step = -jacobian.partialPivLu().solve(residual);
      unknowns_ += scale.cwiseProduct(step);
      if (!step.allFinite()) return false;
      if (step.cwiseAbs().maxCoeff() < 1e-11) {
        Residual(unknowns_, fraction);
        return true;
      }
    }
    return false;
  }

  const Finger finger_;
  const std::vector<PointContact> contacts_;
  const std::vector<BasisPoint> basis_ = MakeBasis();
  std::array<Beam, 2> beams_;
  int dofs_ = 0, size_ = 0;
  Eigen::VectorXd unknowns_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_VARIATIONAL_FINGER_H_

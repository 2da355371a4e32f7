#include "finray/sensing/pair_table.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

constexpr int kPlaces = 12;
// Forces in units of EI / l_0^2; for the paper's finger 1 to 16 N.
constexpr double kPairForces[] = {1.5, 5, 12, 25};
constexpr double kForceStep = 0.6;  // spacing over force
constexpr double kFarthest = 3;     // from a node, in spacings

}  // namespace

PairTable::PairTable(EquilibriumSolver* solver, double friction)
    : friction_(friction) {
  const Finger& finger = solver->model().finger();
  const double unit = ForceUnit(finger);
  const int gauges = solver->model().gauges();
  length_mm_ = finger.front_length_mm;
  const double step = length_mm_ / kPlaces;
  const auto place = [&](int i) { return step * (i + 0.5); };
  for (int first = 0; first < kPlaces; ++first) {
    for (int second = first + 1; second < kPlaces; ++second) {
      std::vector<Node> nodes;
      for (const double f1 : kPairForces) {
        solver->Reset();
        for (const double f2 : kPairForces) {
          // Soft fingers fold over at the heavy end; the table ends there.
          if (!solver->SolveWithSensitivities(
                  {{place(first), f1 * unit, friction},
                   {place(second), f2 * unit, friction}})) {
            break;
          }
          Node node{{place(first), f1 * unit, place(second), f2 * unit},
                    {0.5 * step, kForceStep * f1 * unit, 0.5 * step,
                     kForceStep * f2 * unit},
                    solver->outputs().head(gauges),
                    solver->d_outputs().topLeftCorner(gauges, kUnknowns),
                    solver->state()};
          for (int k = 0; k < kUnknowns; ++k) {
            node.slopes.col(k) *= node.spacing[k];
          }
          nodes.push_back(std::move(node));
        }
      }
      if (!nodes.empty()) pairs_.push_back(std::move(nodes));
    }
  }
  solver->Reset();
}

ContactStart PairTable::StartFrom(const Node& node,
                                  const Eigen::VectorXd& angles_rad,
                                  const Eigen::VectorXd& weight_per_rad) const {
  using Matrix4 = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector4 = Eigen::Matrix<double, kUnknowns, 1>;
  Matrix4 normal = Matrix4::Identity();
  Vector4 right = Vector4::Zero();
  double chi2 = 0;
  for (Eigen::Index j = 0; j < angles_rad.size(); ++j) {
    const double w = weight_per_rad[j];
    if (w == 0) continue;
    const Vector4 slope = w * node.slopes.row(j).transpose();
    const double off = w * (angles_rad[j] - node.angles_rad[j]);
    normal.noalias() += slope * slope.transpose();
    right += off * slope;
    chi2 += off * off;
  }
  const Vector4 steps = normal.ldlt().solve(right);
  ContactStart start;
  start.count = 2;
  start.chi2 = chi2 - right.dot(steps);
  start.state = &node.state;
  for (int k = 0; k < kUnknowns; ++k) {
    const double bounded = std::clamp(steps[k], -kFarthest, kFarthest);
    const double at = node.at[k] + bounded * node.spacing[k];
    PointContact& contact = start.contacts[k / 2];
    if (k % 2 == 0) {
      contact = {std::clamp(at, 0.0, length_mm_), 0, friction_};
    } else {
      contact.normal_N = std::max(0.1 * node.at[k], at);
    }
  }
  return start;
}

void PairTable::FindStarts(const Eigen::VectorXd& angles_rad,
                           const Eigen::VectorXd& weight_per_rad,
                           std::vector<ContactStart>* starts) const {
  const auto better = [](const ContactStart& a, const ContactStart& b) {
    return a.chi2 < b.chi2;
  };
  starts->clear();
  for (const std::vector<Node>& nodes : pairs_) {
    ContactStart best;
    for (const Node& node : nodes) {
      const ContactStart start = StartFrom(node, angles_rad, weight_per_rad);
      if (best.count == 0 || better(start, best)) best = start;
    }
    starts->push_back(best);
  }
  std::sort(starts->begin(), starts->end(), better);
}

}  // namespace finray

#include "finray/perception/force_displacement.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "finray/io/error.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr double kMoved = 3;  // std

}  // namespace

SensedLoads SenseLoads(const FrameTable& table, ContactSensor* sensor,
                       const Finger& finger) {
  const std::vector<Measurements> rows = ReadWithPlaces(table, finger);
  SensedLoads sensed;
  sensed.rows = rows.size();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const SensedFrame frame = sensor->Sense(rows[row]);
    if (frame.contacts.size() != 1) continue;
    sensed.loads.push_back({row, frame.contacts[0], rows[row].object_mm});
  }
  return sensed;
}

SliderDirection EstimateDirection(const SensedLoads& loads, double radius_mm) {
  if (loads.loads.size() < 3) {
    throw InputError(
        "the slider's direction needs 3 rows with one contact, found " +
        std::to_string(loads.loads.size()));
  }
  const auto count = static_cast<double>(loads.loads.size());
  std::vector<Vector2d> ways;
  Vector2d mean(0, 0), push(0, 0);
  for (const SensedLoads::Load& load : loads.loads) {
    const double theta = load.contact.pose[2];
    ways.push_back(CircleCentre(load.contact.pose, radius_mm) - load.place_mm);
    mean += ways.back() / count;
    push -= load.contact.contact.normal_N *
            Vector2d(std::sin(theta), -std::cos(theta));
  }
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Vector2d& way : ways) {
    scatter += (way - mean) * (way - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
  Vector2d along = eigen.eigenvectors().col(1);
  if (along.dot(push) < 0) along = -along;
  const double across = eigen.eigenvalues()[0] / (count - 2);
  return {std::atan2(along.y(), along.x()),
          std::sqrt(across / eigen.eigenvalues()[1])};
}

std::vector<ForcePoint> ForcePoints(const SensedLoads& loads,
                                    double direction_rad, double radius_mm,
                                    double stage_std_mm) {
  const Vector2d e(std::cos(direction_rad), std::sin(direction_rad));
  std::vector<ForcePoint> points;
  for (const SensedLoads::Load& load : loads.loads) {
    const Eigen::Vector3d& pose = load.contact.pose;
    const Vector2d n(std::sin(pose[2]), -std::cos(pose[2]));
    const Vector2d t(std::cos(pose[2]), std::sin(pose[2]));  // dn/dtheta
    const double force = load.contact.contact.normal_N;
    ForcePoint& point = points.emplace_back();
    point.row = load.row;
    point.displacement_mm =
        e.dot(CircleCentre(pose, radius_mm) - load.place_mm);
    point.force_N = -force * n.dot(e);
    point.approach_mm = -e.dot(load.place_mm);
    Eigen::Matrix<double, 2, 4> slope;
    slope << e.x(), e.y(), -radius_mm * e.dot(t), 0, 0, 0, -force * e.dot(t),
        -e.dot(n);
    point.covariance = slope * load.contact.covariance * slope.transpose();
    point.covariance(0, 0) += stage_std_mm * stage_std_mm;
  }
  return points;
}

std::vector<ForcePoint> SqueezePoints(const std::vector<ForcePoint>& first,
                                      const std::vector<ForcePoint>& second) {
  std::vector<ForcePoint> points;
  std::size_t j = 0;
  for (const ForcePoint& a : first) {
    while (j < second.size() && second[j].row < a.row) ++j;
    if (j == second.size()) break;
    const ForcePoint& b = second[j];
    if (b.row != a.row) continue;
    const Eigen::DiagonalMatrix<double, 2> share(1, 0.5);
    ForcePoint& point = points.emplace_back(a);
    point.displacement_mm = a.displacement_mm + b.displacement_mm;
    point.force_N = 0.5 * (a.force_N + b.force_N);
    point.approach_mm = a.approach_mm + b.approach_mm;
    point.covariance = share * (a.covariance + b.covariance) * share;
  }
  return points;
}

void MarkDirections(double stage_std_mm, std::vector<ForcePoint>* points) {
  std::vector<ForcePoint>& p = *points;
  int direction = 1;
  for (std::size_t i = 1; i < p.size(); ++i) {
    const double step = p[i].approach_mm - p[i - 1].approach_mm;
    if (std::abs(step) > kMoved * std::sqrt(2.0) * stage_std_mm) {
      direction = step > 0 ? 1 : -1;
    }
    p[i].direction = direction;
    if (i == 1) p[0].direction = direction;
  }
  // After a reversal the slider stands until it has left the turning point.
  std::size_t turn = 0;
  bool slides = true;
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (p[i].direction != p[i - 1].direction) {
      turn = i - 1;
      slides = false;
    }
    const double way =
        p[i].direction * (p[i].displacement_mm - p[turn].displacement_mm);
    const double error =
        std::sqrt(p[i].covariance(0, 0) + p[turn].covariance(0, 0));
    slides = slides || way > kMoved * error;
    p[i].slides = slides;
  }
}

}  // namespace finray

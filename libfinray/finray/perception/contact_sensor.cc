#include "finray/perception/contact_sensor.h"

#include "finray/io/error.h"

namespace finray {

ContactSensor::ContactSensor(const Finger& finger, const Scene& scene,
                             const Discretization& discretization)
    : scene_(scene),
      estimator_(finger, scene, discretization),
      solver_(finger, discretization) {}

SensedFrame ContactSensor::Sense(const Measurements& readings) {
  const FrameEstimate estimate = estimator_.Estimate(readings);
  SensedFrame frame;
  frame.status = estimate.status;
  if (estimate.status != FrameStatus::kOk) return frame;
  std::vector<PointContact> contacts;
  for (int c = 0; c < estimate.contacts; ++c) {
    contacts.push_back({estimate.contact[c].arc_mm,
                        estimate.contact[c].normal_N,
                        scene_.friction_coefficient});
  }
  const double scale = estimate.noise_scale();
  return At(contacts, scale * scale * estimate.noise_covariance);
}

SensedFrame ContactSensor::FromEstimate(
    const std::vector<PointContact>& contacts,
    const std::vector<Eigen::Vector2d>& std) {
  const auto unknowns = static_cast<Eigen::Index>(2 * contacts.size());
  ContactMatrix covariance = ContactMatrix::Zero(unknowns, unknowns);
  for (std::size_t c = 0; c < std.size(); ++c) {
    covariance.diagonal().segment<2>(2 * static_cast<Eigen::Index>(c)) =
        std[c].cwiseAbs2();
  }
  return At(contacts, covariance);
}

SensedFrame ContactSensor::At(const std::vector<PointContact>& contacts,
                              const ContactMatrix& covariance) {
  const auto unknowns = static_cast<Eigen::Index>(2 * contacts.size());
  SensedFrame frame;
  solver_.Reset();
  if (!solver_.SolveWithSensitivities(contacts)) {
    frame.status = FrameStatus::kNotConverged;
    return frame;
  }
  frame.status = FrameStatus::kOk;
  frame.shape.emplace(solver_, contacts);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto first = static_cast<Eigen::Index>(c);
    Eigen::Matrix<double, 4, Eigen::Dynamic> slope(4, unknowns);
    slope.topRows<3>() = solver_.d_outputs().block(
        solver_.model().gauges() + 3 * first, 0, 3, unknowns);
    slope.row(3).setZero();
    slope(3, 2 * first + 1) = 1;
    frame.contacts.push_back({contacts[c],
                              solver_.contact_pose(static_cast<int>(c)),
                              slope * covariance * slope.transpose()});
  }
  return frame;
}

std::vector<Measurements> ReadWithPlaces(
    const FrameTable& table, const Finger& finger,
    const MeasurementColumns::Options& options) {
  for (const char* name : {"object_x_mm", "object_y_mm"}) table.Numbers(name);
  const std::vector<Measurements> rows =
      ReadMeasurements(table, finger, options);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].object_mm.allFinite()) continue;
    throw InputError(table.path() + ":" + std::to_string(table.line(row)) +
                     ": no object_x_mm, object_y_mm; every row needs the "
                     "place of the object");
  }
  return rows;
}

}  // namespace finray

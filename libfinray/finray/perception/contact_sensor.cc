#include "finray/perception/contact_sensor.h"

#include <Eigen/Geometry>
#include <cmath>

#include "finray/io/error.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/history_filter.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr int kBeamPoints = 281;

// The frame of a row that holds estimated contacts.
SensedFrame FromColumns(const FrameTable& table, std::size_t row,
                        double friction, ContactSensor* sensor) {
  const auto cell = [&](const std::string& name) {
    return table.Numbers(name)[row];
  };
  std::vector<PointContact> contacts;
  ContactMatrix covariance =
      ContactMatrix::Zero(2 * kFittedContacts, 2 * kFittedContacts);
  for (int c = 0; c < kFittedContacts && table.Has(ContactArc(c)); ++c) {
    const double arc = cell(ContactArc(c)), normal = cell(NormalForce(c));
    if (std::isnan(arc) || !(normal > 0)) continue;
    const Vector2d std(cell(ContactArcStd(c)), cell(NormalForceStd(c)));
    if (!std.allFinite()) {
      throw InputError(table.path() + ":" + std::to_string(table.line(row)) +
                       ": contact " + std::to_string(c + 1) + " has no std");
    }
    covariance.diagonal().segment<2>(
        2 * static_cast<Eigen::Index>(contacts.size())) = std.cwiseAbs2();
    contacts.push_back({arc, normal, friction});
  }
  if (contacts.empty()) return {FrameStatus::kNoContact, {}, {}};
  const auto unknowns = static_cast<Eigen::Index>(2 * contacts.size());
  return sensor->At(contacts, covariance.topLeftCorner(unknowns, unknowns));
}

void AddTouches(std::size_t row, const SensedFrame& frame,
                const Measurements& measured, double length,
                std::vector<Touch>* touches) {
  const Vector2d& origin = measured.object_mm;
  const Eigen::Rotation2Dd back(-measured.object_angle_rad);
  std::vector<Vector2d> beam;
  for (int i = 0; i < kBeamPoints; ++i) {
    const Section at =
        frame.shape->At(Side::kFront, length * i / (kBeamPoints - 1));
    beam.push_back(back * (Vector2d(at.x_mm, at.y_mm) - origin));
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = back.toRotationMatrix();
  for (const SensedContact& sensed : frame.contacts) {
    Touch& touch = touches->emplace_back();
    touch.row = row;
    touch.point_mm = back * (sensed.pose.head<2>() - origin);
    touch.normal_angle_rad = std::remainder(
        sensed.pose[2] - M_PI / 2 - measured.object_angle_rad, 2 * M_PI);
    touch.normal_N = sensed.contact.normal_N;
    touch.covariance =
        turn * sensed.covariance.topLeftCorner<3, 3>() * turn.transpose();
    touch.beam_mm = beam;
    touch.contact_arc_mm = sensed.contact.arc_mm;
    touch.beam_length_mm = length;
  }
}

}  // namespace

ContactSensor::ContactSensor(const Finger& finger, const Scene& scene,
                             const Discretization& discretization)
    : scene_(scene),
      estimator_(finger, scene, discretization),
      solver_(finger, discretization) {}

SensedFrame ContactSensor::Sense(const Measurements& readings) {
  const FrameEstimate estimate = estimator_.Estimate(readings);
  if (estimate.status != FrameStatus::kOk) return {estimate.status, {}, {}};
  // An edge and a corner touch at two places.
  if (estimate.may_be_two) return {FrameStatus::kUnobservable, {}, {}};
  std::vector<PointContact> contacts;
  for (int c = 0; c < estimate.contacts; ++c) {
    contacts.push_back({estimate.contact[c].arc_mm,
                        estimate.contact[c].normal_N,
                        scene_.friction_coefficient});
  }
  const double scale = estimate.noise_scale();
  return At(contacts, scale * scale * estimate.noise_covariance);
}

SensedFrame ContactSensor::At(const std::vector<PointContact>& contacts,
                              const ContactMatrix& covariance) {
  const auto unknowns = static_cast<Eigen::Index>(2 * contacts.size());
  solver_.Reset();
  if (!solver_.SolveWithSensitivities(contacts)) {
    return {FrameStatus::kNotConverged, {}, {}};
  }
  SensedFrame frame{FrameStatus::kOk, {}, Shape(solver_, contacts)};
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
  RequireTimeForCreep(finger, table.headers(), table.path());
  std::vector<Measurements> rows = ReadMeasurements(table, finger, options);
  HistoryFilter history(finger);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (!history.empty() && !options.gauges_may_lack) {
      history.Remove(&rows[row]);
    }
    if (rows[row].object_mm.allFinite()) continue;
    throw InputError(table.path() + ":" + std::to_string(table.line(row)) +
                     ": no object_x_mm, object_y_mm; every row needs the "
                     "place of the object");
  }
  return rows;
}

Vector2d Touch::Normal() const {
  return {std::cos(normal_angle_rad), std::sin(normal_angle_rad)};
}

std::vector<Vector2d> Touch::BeamNear(double reach_mm) const {
  std::vector<Vector2d> near;
  const double step = beam_length_mm / static_cast<double>(beam_mm.size() - 1);
  for (std::size_t i = 0; i < beam_mm.size(); ++i) {
    const double arc = step * static_cast<double>(i);
    if (std::abs(arc - contact_arc_mm) <= reach_mm) near.push_back(beam_mm[i]);
  }
  return near;
}

std::size_t Touches::all_rows() const {
  std::size_t all = 0;
  for (const auto& [status, count] : rows) all += count;
  return all;
}

Touches SenseTouches(const FrameTable& table, const Finger& finger,
                     const Scene& scene, const Discretization& discretization) {
  const bool estimated = !table.Has(GaugeVolts(0)) &&
                         !table.Has(GaugeAngle(0)) && table.Has(ContactArc(0));
  MeasurementColumns::Options options;
  options.gauges_may_lack = estimated;
  const std::vector<Measurements> rows = ReadWithPlaces(table, finger, options);
  ContactSensor sensor(finger, scene, discretization);
  Touches touches;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const SensedFrame frame =
        estimated ? FromColumns(table, row, scene.friction_coefficient, &sensor)
                  : sensor.Sense(rows[row]);
    ++touches.rows[frame.status];
    if (frame.status == FrameStatus::kOk) {
      AddTouches(row, frame, rows[row], finger.front_length_mm,
                 &touches.usable);
    }
  }
  return touches;
}

}  // namespace finray

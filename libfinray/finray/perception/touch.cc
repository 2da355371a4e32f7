#include "finray/perception/touch.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "finray/io/error.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/measurement_columns.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr int kBeamPoints = 281;

// What a row of the table gives to sense from.
class TouchReader {
 public:
  TouchReader(const FrameTable& table, const Finger& finger)
      : table_(table),
        estimated_(!table.Has(GaugeVolts(0)) && !table.Has(GaugeAngle(0)) &&
                   table.Has(ContactArc(0))) {
    for (const char* place : {"object_x_mm", "object_y_mm"}) {
      table.Numbers(place);  // Throws if there is none.
    }
    MeasurementColumns::Options options;
    options.gauges_may_lack = estimated_;
    rows_ = ReadMeasurements(table, finger, options);
    if (!estimated_) return;
    for (int c = 0; c < kFittedContacts && table.Has(ContactArc(c)); ++c) {
      given_.push_back(
          {&table.Numbers(ContactArc(c)), &table.Numbers(ContactArcStd(c)),
           &table.Numbers(NormalForce(c)), &table.Numbers(NormalForceStd(c))});
    }
  }

  bool estimated() const { return estimated_; }

  ObjectPose Pose(std::size_t row) const {
    const ObjectPose pose{rows_[row].object_mm, rows_[row].object_angle_rad};
    if (!pose.position_mm.allFinite()) {
      throw InputError(Place(row) +
                       "no object_x_mm, object_y_mm; every touch needs the "
                       "place of the object");
    }
    return pose;
  }

  const Measurements& Readings(std::size_t row) const { return rows_[row]; }

  SensedFrame Estimated(std::size_t row, double friction,
                        ContactSensor* sensor) const {
    std::vector<PointContact> contacts;
    std::vector<Vector2d> std;
    SensedFrame frame;
    frame.status = FrameStatus::kNoContact;
    for (std::size_t c = 0; c < given_.size(); ++c) {
      const Given& given = given_[c];
      const double arc = (*given.arc)[row], normal = (*given.normal)[row];
      if (std::isnan(arc) || !(normal > 0)) continue;
      const Vector2d errors((*given.arc_std)[row], (*given.normal_std)[row]);
      if (!errors.allFinite()) {
        throw InputError(Place(row) + "contact " + std::to_string(c + 1) +
                         " has no std");
      }
      contacts.push_back({arc, normal, friction});
      std.push_back(errors);
    }
    if (contacts.empty()) return frame;
    return sensor->FromEstimate(contacts, std);
  }

 private:
  std::string Place(std::size_t row) const {
    return table_.path() + ":" + std::to_string(table_.line(row)) + ": ";
  }

  struct Given {
    const std::vector<double>*arc, *arc_std, *normal, *normal_std;
  };

  const FrameTable& table_;
  bool estimated_;  // The table has contacts, but no gauges.
  std::vector<Measurements> rows_;
  std::vector<Given> given_;
};

void AddTouches(std::size_t row, const SensedFrame& frame,
                const ObjectPose& pose, double length,
                std::vector<Touch>* touches) {
  const Eigen::Rotation2Dd back(-pose.angle_rad);
  std::vector<Vector2d> beam;
  for (int i = 0; i < kBeamPoints; ++i) {
    const Section at =
        frame.shape->At(Side::kFront, length * i / (kBeamPoints - 1));
    beam.push_back(back * (Vector2d(at.x_mm, at.y_mm) - pose.position_mm));
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = back.toRotationMatrix();
  for (const SensedContact& sensed : frame.contacts) {
    Touch& touch = touches->emplace_back();
    touch.row = row;
    touch.point_mm = back * (sensed.pose.head<2>() - pose.position_mm);
    touch.normal_angle_rad =
        std::remainder(sensed.pose[2] - M_PI / 2 - pose.angle_rad, 2 * M_PI);
    touch.normal_N = sensed.contact.normal_N;
    touch.covariance =
        turn * sensed.covariance.topLeftCorner<3, 3>() * turn.transpose();
    touch.beam_mm = beam;
    touch.contact_arc_mm = sensed.contact.arc_mm;
    touch.beam_length_mm = length;
  }
}

}  // namespace

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
  const TouchReader reader(table, finger);
  std::vector<ObjectPose> poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    poses.push_back(reader.Pose(row));
  }
  ContactSensor sensor(finger, scene, discretization);
  Touches touches;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const SensedFrame frame =
        reader.estimated()
            ? reader.Estimated(row, scene.friction_coefficient, &sensor)
            : sensor.Sense(reader.Readings(row));
    ++touches.rows[frame.status];
    if (frame.status == FrameStatus::kOk) {
      AddTouches(row, frame, poses[row], finger.front_length_mm,
                 &touches.usable);
    }
  }
  return touches;
}

}  // namespace finray

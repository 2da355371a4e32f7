#include "finray/sensing/simulation.h"

#include <cmath>
#include <random>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/sensing/frame_columns.h"
#include "finray/statics/circle_contact.h"
#include "finray/statics/shape.h"

namespace finray {
namespace {

struct Row {
  std::vector<PointContact> contacts;
  bool object = false;
  Circle circle;
};

class LoadReader {
 public:
  LoadReader(const Finger& finger, const Scene& scene, const FrameTable& table)
      : finger_(finger), scene_(scene), table_(table) {
    for (int c = 0; table.Has(ContactArc(c)); ++c) {
      arc_.push_back(table.Numbers(ContactArc(c)));
      normal_.push_back(table.Numbers(NormalForce(c)));
      friction_.push_back(table.NumbersOrNan(Friction(c)));
    }
    x_ = table.NumbersOrNan("object_x_mm");
    y_ = table.NumbersOrNan("object_y_mm");
    if (table.Has("object_x_mm") && arc_.empty() && !scene.circle_radius_mm) {
      throw InputError(table.path() +
                       ": has the object's place, but the scene has no object; "
                       "give one with --scene");
    }
  }

  int contacts() const { return static_cast<int>(arc_.size()); }

  Row Read(std::size_t row) const {
    Row load;
    for (int c = 0; c < contacts(); ++c) {
      const double arc = arc_[c][row], normal = normal_[c][row];
      if (std::isnan(arc) && (std::isnan(normal) || normal == 0)) continue;
      if (!(arc >= 0 && arc <= finger_.front_length_mm)) {
        Fail(row, ContactArc(c) +
                      ": expected an arc length on the front beam, "
                      "0 to " +
                      std::to_string(finger_.front_length_mm) + " mm");
      }
      if (!(normal >= 0)) {
        Fail(row, NormalForce(c) + ": expected a force of at least 0 N with " +
                      ContactArc(c));
      }
      const double mu = friction_[c][row];
      load.contacts.push_back(
          {arc, normal, std::isnan(mu) ? scene_.friction_coefficient : mu});
    }
    if (load.contacts.empty() && std::isfinite(x_[row]) &&
        std::isfinite(y_[row]) && scene_.circle_radius_mm) {
      load.object = true;
      load.circle = {{x_[row], y_[row]}, *scene_.circle_radius_mm};
    }
    return load;
  }

 private:
  [[noreturn]] void Fail(std::size_t row, const std::string& message) const {
    throw InputError(table_.path() + ":" + std::to_string(table_.line(row)) +
                     ": " + message);
  }

  const Finger& finger_;
  const Scene& scene_;
  const FrameTable& table_;
  std::vector<std::vector<double>> arc_, normal_, friction_;
  std::vector<double> x_, y_;
};

void AddShape(const EquilibriumSolver& solver,
              const std::vector<PointContact>& contacts, std::size_t row,
              FrameTable* shapes, std::size_t* next) {
  constexpr int kPoints = 100;
  const Shape shape(solver, contacts);
  for (const Side side : {Side::kFront, Side::kBack}) {
    const double length = BeamLength(solver.model().finger(), side);
    for (int i = 0; i <= kPoints; ++i) {
      const double arc = length * i / kPoints;
      const Section at = shape.At(side, arc);
      const std::size_t k = (*next)++;
      shapes->MutableNumbers("row")[k] = static_cast<double>(row + 1);
      shapes->MutableText("beam")[k] = side == Side::kFront ? "front" : "back";
      shapes->MutableNumbers("arc_mm")[k] = arc;
      shapes->MutableNumbers("x_mm")[k] = at.x_mm;
      shapes->MutableNumbers("y_mm")[k] = at.y_mm;
      shapes->MutableNumbers("angle_rad")[k] = at.theta_rad;
      shapes->MutableNumbers("moment_N_mm")[k] = at.moment_N_mm;
    }
  }
}

const char* Reason(CircleContactStatus status) {
  return status == CircleContactStatus::kNoTangency
             ? "the object meets an end of the front beam, not its side"
             : "no equilibrium found under this load";
}

}  // namespace

SimulationSummary Simulate(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           FrameTable* frames, FrameTable* shapes) {
  const LoadReader loads(finger, scene, *frames);
  const std::size_t rows = frames->rows();
  // A bad row is found before any is solved.
  bool objects = false;
  std::vector<Row> all;
  for (std::size_t row = 0; row < rows; ++row) {
    all.push_back(loads.Read(row));
    objects |= all.back().object;
  }
  const int contacts = std::max(loads.contacts(), objects ? 1 : 0);
  // In the order in which they shall stand.
  std::vector<std::string> names;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    names.insert(names.end(), {GaugeVolts(j), GaugeAngle(j)});
  }
  for (int c = 0; c < contacts; ++c) {
    names.insert(names.end(), {ContactX(c), ContactY(c), ContactAngle(c)});
  }
  if (objects) names.insert(names.end(), {ContactArc(0), NormalForce(0)});
  for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
    names.push_back(RibForce(i));
  }
  names.insert(names.end(),
               {"force_N", "tip_x_mm", "tip_y_mm", "tip_angle_rad"});
  for (const std::string& name : names) {
    auto& column = frames->MutableNumbers(name);
    const bool load = name == ContactArc(0) || name == NormalForce(0);
    if (!load) column.assign(rows, std::nan(""));
  }
  frames->MutableText("status").assign(rows, "");
  const auto set = [&](const std::string& name, std::size_t row, double value) {
    frames->MutableNumbers(name)[row] = value;
  };
  if (shapes != nullptr) *shapes = FrameTable(rows * 202);
  std::size_t next_shape = 0;

  SimulationSummary summary;
  EquilibriumSolver solver(finger, discretization);
  for (std::size_t row = 0; row < rows; ++row) {
    Row& load = all[row];
    bool solved;
    const char* reason = "no equilibrium found under this load";
    if (load.object) {
      // Every row on its own, so that it does not depend on those before.
      solver.Reset();
      PointContact contact;
      const CircleContactStatus status = SolveCircleContact(
          load.circle, scene.friction_coefficient, &solver, &contact);
      reason = Reason(status);
      solved = status == CircleContactStatus::kContact;
      if (solved) {
        load.contacts = {contact};
        set(ContactArc(0), row, contact.arc_mm);
        set(NormalForce(0), row, contact.normal_N);
      } else if (status == CircleContactStatus::kNoContact) {
        solved = solver.Solve({});
        set(NormalForce(0), row, 0);
      }
    } else {
      solver.Reset();
      solved = solver.Solve(load.contacts);
    }
    if (!solved) {
      ++summary.not_converged;
      frames->MutableText("status")[row] = "not_converged";
      if (summary.first_failure.empty()) {
        summary.first_failure = frames->path() + ":" +
                                std::to_string(frames->line(row)) + ": " +
                                reason;
      }
      continue;
    }
    Eigen::Vector2d force(0, 0);
    for (std::size_t c = 0; c < load.contacts.size(); ++c) {
      const int index = static_cast<int>(c);
      const Eigen::Vector3d pose = solver.contact_pose(index);
      set(ContactX(index), row, pose.x());
      set(ContactY(index), row, pose.y());
      set(ContactAngle(index), row, pose.z());
      const Eigen::Vector2d t(std::cos(pose.z()), std::sin(pose.z()));
      force += load.contacts[c].normal_N *
               (Eigen::Vector2d(t.y(), -t.x()) + load.contacts[c].friction * t);
    }
    set("force_N", row, force.norm());
    for (int j = 0; j < solver.model().gauges(); ++j) {
      const Gauge& gauge = finger.gauges[j];
      const double angle = solver.gauge_angle(j);
      set(GaugeAngle(j), row, angle);
      set(GaugeVolts(j), row, gauge.gain_V_per_rad * angle + gauge.offset_V);
    }
    for (int i = 0; i < solver.model().ribs(); ++i) {
      set(RibForce(i), row, solver.rib_tension(i));
    }
    const Eigen::Vector3d tip = solver.tip_pose();
    set("tip_x_mm", row, tip.x());
    set("tip_y_mm", row, tip.y());
    set("tip_angle_rad", row, tip.z());
    const bool touches = force.norm() > 0;
    ++(touches ? summary.contact : summary.free);
    frames->MutableText("status")[row] = touches ? "ok" : "no_contact";
    if (shapes != nullptr) {
      AddShape(solver, load.contacts, row, shapes, &next_shape);
    }
  }
  if (shapes != nullptr) shapes->Truncate(next_shape);
  return summary;
}

FrameTable MakeLog(const Finger& finger, const FrameTable& simulated,
                   const LogNoise& noise) {
  std::vector<std::size_t> kept;
  const auto& tip = simulated.Numbers("tip_x_mm");
  for (std::size_t row = 0; row < simulated.rows(); ++row) {
    if (std::isfinite(tip[row])) kept.push_back(row);
  }
  FrameTable log(kept.size());
  std::mt19937_64 generator(noise.seed);
  std::normal_distribution<double> normal;
  const auto copy = [&](const std::string& name, double std) {
    const std::vector<double> from = simulated.NumbersOrNan(name);
    std::vector<double>& to = log.MutableNumbers(name);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      to[i] = from[kept[i]] + (std > 0 ? std * normal(generator) : 0.0);
    }
  };
  if (simulated.Has("time_s")) copy("time_s", 0);
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    copy(GaugeVolts(static_cast<int>(j)), finger.gauges[j].noise_V);
  }
  copy("force_N", noise.force_std_N);
  if (simulated.Has("object_x_mm")) {
    copy("object_x_mm", noise.object_std_mm);
    copy("object_y_mm", noise.object_std_mm);
  }
  return log;
}

}  // namespace finray

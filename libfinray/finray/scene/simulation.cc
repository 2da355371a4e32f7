#include "finray/scene/simulation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "finray/finger/geometry.h"
#include "finray/finger/point_contact.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"
#include "finray/objects/object_contact.h"
#include "finray/objects/sliding_friction.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/history_filter.h"
#include "finray/statics/shape.h"

namespace finray {
namespace {

constexpr char kDisplacement[] = "object_displacement_mm";

// One row of a frame table: the load on the finger and the solution. Numbers
// are NaN if there is no solution.
struct Row {
  std::vector<PointContact> contacts;  // of the load, or found with the object
  std::optional<ObjectPose> object;    // only if the load has no contacts
  bool solved = false;
  double displacement_mm = kNaN;
  Eigen::VectorXd outputs;  // EquilibriumSolver::outputs
  Eigen::VectorXd rib_tensions;
  std::vector<Eigen::Vector2d> pins;  // front and back of each rib
  std::string failure;                // why it is not solved
};

// Reads the loads of all rows. Throws InputError with the line of a load that
// is incomplete, negative or off the beam. `contacts` is the number of point
// contacts that the columns can hold.
std::vector<Row> ReadLoads(const Finger& finger, const Scene& scene,
                           const FrameTable& table, int* contacts) {
  std::vector<std::vector<double>> arcs, normals, frictions;
  for (int c = 0; table.Has(ContactArc(c)); ++c) {
    arcs.push_back(table.Numbers(ContactArc(c)));
    normals.push_back(table.Numbers(NormalForce(c)));
    frictions.push_back(table.NumbersOrNan(Friction(c)));
  }
  *contacts = static_cast<int>(arcs.size());
  const std::vector<Side>& beams = scene.contact_beams;
  if (!beams.empty() && arcs.size() > beams.size()) {
    throw InputError(scene.contact_beams_place +
                     "contact_beams: expected a word for each "
                     "of the " +
                     std::to_string(arcs.size()) + " contacts in " +
                     table.path() + ", found " + std::to_string(beams.size()));
  }
  if (table.Has("object_x_mm") && arcs.empty() && !scene.object) {
    throw InputError(table.path() +
                     ": has the object's place, but the scene has no object; "
                     "give one with --scene");
  }
  const std::vector<double> x = table.NumbersOrNan("object_x_mm");
  const std::vector<double> y = table.NumbersOrNan("object_y_mm");
  const std::vector<double> angle_deg = table.NumbersOrNan("object_angle_deg");
  std::vector<Row> loads(table.rows());
  for (std::size_t row = 0; row < loads.size(); ++row) {
    Row& load = loads[row];
    const auto fail = [&](const std::string& message) {
      throw InputError(table.path() + ":" + std::to_string(table.line(row)) +
                       ": " + message);
    };
    for (int c = 0; c < *contacts; ++c) {
      const double arc = arcs[c][row], normal = normals[c][row];
      if (std::isnan(arc) && (std::isnan(normal) || normal == 0)) continue;
      const Side side = beams.empty() ? Side::kFront : beams[c];
      const double length = BeamLength(finger, side);
      if (!(arc >= 0 && arc <= length)) {
        fail(ContactArc(c) + ": expected an arc length on the " +
             SideName(side) + " beam, 0 to " + std::to_string(length) + " mm");
      }
      if (!(normal >= 0)) {
        fail(NormalForce(c) + ": expected a force of at least 0 N with " +
             ContactArc(c));
      }
      const double mu = frictions[c][row];
      load.contacts.push_back({arc, normal,
                               std::isnan(mu) ? scene.friction_coefficient : mu,
                               side});
    }
    if (std::isnan(x[row]) != std::isnan(y[row])) {
      fail("object_x_mm and object_y_mm: expected both or neither");
    }
    if (load.contacts.empty() && std::isfinite(x[row]) && scene.object) {
      const double turn = std::isnan(angle_deg[row]) ? 0 : angle_deg[row];
      load.object = {{x[row], y[row]}, turn * M_PI / 180};
    }
  }
  return loads;
}

void AddShape(const Finger& finger, const Shape& shape, std::size_t row,
              FrameTable* shapes, std::size_t* next) {
  constexpr int kPoints = 100;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const double length = BeamLength(finger, side);
    for (int i = 0; i <= kPoints; ++i) {
      const double arc = length * i / kPoints;
      const Section at = shape.At(side, arc);
      const std::size_t k = (*next)++;
      shapes->MutableNumbers("row")[k] = static_cast<double>(row + 1);
      shapes->MutableText("beam")[k] = SideName(side);
      shapes->MutableNumbers("arc_mm")[k] = arc;
      shapes->MutableNumbers("x_mm")[k] = at.x_mm;
      shapes->MutableNumbers("y_mm")[k] = at.y_mm;
      shapes->MutableNumbers("angle_rad")[k] = at.theta_rad;
      shapes->MutableNumbers("moment_N_mm")[k] = at.moment_N_mm;
    }
  }
}

// Finds the contact of the scene's object in a row. `sliding` has seen the rows
// before; null if there is no friction.
ObjectContact ObjectContactOf(const Scene& scene, const ObjectPose& object,
                              SlidingFriction* sliding,
                              EquilibriumSolver* solver) {
  if (sliding != nullptr && sliding->Next(object, solver)) {
    return sliding->contact();
  }
  solver->Reset();
  return SolveObjectContact(*scene.object, object, scene.friction_coefficient,
                            solver);
}

void SolveRow(const Scene& scene, SlidingFriction* sliding,
              EquilibriumSolver* solver, Row* row) {
  if (sliding != nullptr && !row->object) sliding->Lift();
  if (row->object) {
    const ObjectContact found =
        ObjectContactOf(scene, *row->object, sliding, solver);
    row->solved = found.status == ObjectContactStatus::kContact ||
                  found.status == ObjectContactStatus::kNoContact;
    row->contacts = found.contacts;
    row->displacement_mm = row->solved ? found.displacement_mm : kNaN;
    if (found.status == ObjectContactStatus::kNoTangency) {
      row->failure = "the object meets an end of the front beam, not its side";
    } else if (!row->solved) {
      row->failure = "no equilibrium found against this object";
    }
  } else {
    // Every row starts from the unloaded finger, so that its result does not
    // depend on the rows before.
    solver->Reset();
    row->solved = solver->Solve(row->contacts);
    row->failure = solver->Why();
  }
  const LadderModel& model = solver->model();
  row->outputs.setConstant(model.gauges() + 3, kNaN);
  row->rib_tensions.setConstant(model.ribs(), kNaN);
  row->pins.assign(2 * model.ribs(), {kNaN, kNaN});
  if (!row->solved) return;
  row->outputs = solver->outputs();
  row->rib_tensions = solver->state().q.tail(model.ribs());
}

// Front and back of each rib.
std::vector<Eigen::Vector2d> Pins(const Finger& finger, const Shape& shape) {
  std::vector<Eigen::Vector2d> pins;
  for (const Rib& rib : finger.ribs) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Section at =
          shape.At(side, side == Side::kFront ? rib.front_mm : rib.back_mm);
      pins.emplace_back(at.x_mm, at.y_mm);
    }
  }
  return pins;
}

// Fills in a row. Returns the force on the finger.
double FillRow(const Finger& finger, const Row& solved, int contacts,
               bool displacement, bool friction, std::size_t row,
               FrameTable* frames) {
  const auto set = [&](const std::string& name, double value) {
    frames->MutableNumbers(name)[row] = value;
  };
  const int gauges = static_cast<int>(finger.gauges.size());
  for (int j = 0; j < gauges; ++j) {
    set(GaugeVolts(j), finger.gauges[j].Volts(solved.outputs[j]));
    set(GaugeAngle(j), solved.outputs[j]);
  }
  Eigen::Vector2d force(0, 0);
  const int touching = static_cast<int>(solved.contacts.size());
  for (int c = 0; c < contacts; ++c) {
    Eigen::Vector3d pose = Eigen::Vector3d::Constant(kNaN);
    if (solved.solved && c < touching) {
      pose = solved.outputs.segment<3>(gauges + 3 * c);
      force += ContactForce(solved.contacts[c], pose.z());
    }
    set(ContactX(c), pose.x());
    set(ContactY(c), pose.y());
    set(ContactAngle(c), pose.z());
  }
  if (displacement) set(kDisplacement, solved.displacement_mm);
  const int ribs = static_cast<int>(finger.ribs.size());
  for (int i = 0; i < ribs; ++i) set(RibForce(i), solved.rib_tensions[i]);
  for (int i = 0; i < ribs; ++i) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const auto& pin = solved.pins[2 * i + LadderModel::Index(side)];
      set(RibPin(i, SideName(side), "x"), pin.x());
      set(RibPin(i, SideName(side), "y"), pin.y());
    }
  }
  set("force_N", solved.solved ? force.norm() : kNaN);
  const Eigen::Vector3d tip = solved.outputs.tail<3>();
  set("tip_x_mm", tip.x());
  set("tip_y_mm", tip.y());
  set("tip_angle_rad", tip.z());
  // Other rows may give their loads in these columns, so they are kept there.
  if (!solved.solved || !solved.object) return force.norm();
  if (touching == 0) set(NormalForce(0), 0);
  for (int c = 0; c < touching; ++c) {
    set(ContactArc(c), solved.contacts[c].arc_mm);
    set(NormalForce(c), solved.contacts[c].normal_N);
    if (friction) set(Friction(c), solved.contacts[c].friction);
  }
  return force.norm();
}

// Adds the hysteresis to the volts of the rows.
void AddHysteresis(const Finger& finger, FrameTable* frames) {
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    const Gauge& gauge = finger.gauges[j];
    if (gauge.hysteresis_rad == 0) continue;
    Play play(gauge.HysteresisV());
    for (double& volts : frames->MutableNumbers(GaugeVolts(j))) {
      if (std::isnan(volts)) continue;
      volts = gauge.offset_V + play.Next(volts - gauge.offset_V);
    }
  }
}

// Adds the creep to the volts of the rows.
void AddCreep(const Finger& finger, FrameTable* frames) {
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    const Gauge& gauge = finger.gauges[j];
    if (gauge.creep_share == 0) continue;
    GaugeLag<double> lag(0, gauge.creep_time_constant_s);
    const std::vector<double>& times_s = frames->Numbers("time_s");
    std::vector<double>& volts = frames->MutableNumbers(GaugeVolts(j));
    for (std::size_t row = 0; row < volts.size(); ++row) {
      if (std::isnan(volts[row])) continue;
      volts[row] += gauge.creep_share *
                    lag.Next(times_s[row], volts[row] - gauge.offset_V);
    }
  }
}

}  // namespace

SimulationSummary Simulate(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           FrameTable* frames, FrameTable* shapes) {
  // All loads are read first, so that a bad row is reported before any is
  // solved.
  RequireTimeForCreep(finger, frames->headers(), frames->path());
  int contacts = 0;
  std::vector<Row> rows = ReadLoads(finger, scene, *frames, &contacts);
  if (shapes != nullptr) *shapes = FrameTable(rows.size() * 202);
  std::size_t next_shape = 0;

  EquilibriumSolver solver(finger, discretization);
  std::optional<SlidingFriction> sliding;
  if (scene.object && scene.presliding_mm && scene.friction_coefficient > 0) {
    sliding.emplace(*scene.object, scene.friction_coefficient,
                    *scene.presliding_mm, 0);
  }
  int object_contacts = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = rows[i];
    SolveRow(scene, sliding ? &*sliding : nullptr, &solver, &row);
    if (row.object) {
      object_contacts =
          std::max({object_contacts, 1, static_cast<int>(row.contacts.size())});
    }
    if (!row.solved) continue;
    const Shape shape(solver, row.contacts);
    row.pins = Pins(finger, shape);
    if (shapes != nullptr) AddShape(finger, shape, i, shapes, &next_shape);
  }
  if (shapes != nullptr) shapes->Truncate(next_shape);

  SimulationSummary summary;
  const bool displacement = object_contacts > 0 && scene.object->spring;
  for (int c = 0; c < object_contacts; ++c) {
    frames->MutableNumbers(ContactArc(c));
    frames->MutableNumbers(NormalForce(c));
  }
  contacts = std::max(contacts, object_contacts);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool touches = FillRow(finger, rows[i], contacts, displacement,
                                 sliding.has_value(), i, frames) > 0;
    std::string& status = frames->MutableText("status")[i];
    if (!rows[i].solved) {
      ++summary.not_converged;
      status = "not_converged";
      if (summary.first_failure.empty()) {
        summary.first_failure = frames->path() + ":" +
                                std::to_string(frames->line(i)) + ": " +
                                rows[i].failure;
      }
      continue;
    }
    ++(touches ? summary.contact : summary.free);
    status = touches ? "ok" : "no_contact";
  }
  AddHysteresis(finger, frames);
  AddCreep(finger, frames);
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
  if (simulated.Has("object_angle_deg")) copy("object_angle_deg", 0);
  if (!(noise.pin_std_mm > 0)) return log;
  for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      copy(RibPin(i, SideName(side), "x"), noise.pin_std_mm);
      copy(RibPin(i, SideName(side), "y"), noise.pin_std_mm);
    }
  }
  return log;
}

}  // namespace finray

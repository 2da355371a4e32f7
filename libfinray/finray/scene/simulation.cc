#include "finray/scene/simulation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "finray/finger/geometry.h"
#include "finray/finger/point_contact.h"
#include "finray/objects/object_contact.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/load_reader.h"
#include "finray/statics/shape.h"

namespace finray {
namespace {

constexpr char kDisplacement[] = "object_displacement_mm";

// The solution of one row.
struct SolvedRow {
  ObjectContactStatus status = ObjectContactStatus::kNotConverged;
  bool object = false;
  std::vector<PointContact> contacts;
  double displacement_mm = 0;
  Eigen::VectorXd outputs;  // EquilibriumSolver::outputs
  Eigen::VectorXd rib_tensions;
  std::vector<Eigen::Vector2d> pins;  // front and back of each rib
  std::string failure;                // why it is not solved
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
      shapes->MutableText("beam")[k] = SideName(side);
      shapes->MutableNumbers("arc_mm")[k] = arc;
      shapes->MutableNumbers("x_mm")[k] = at.x_mm;
      shapes->MutableNumbers("y_mm")[k] = at.y_mm;
      shapes->MutableNumbers("angle_rad")[k] = at.theta_rad;
      shapes->MutableNumbers("moment_N_mm")[k] = at.moment_N_mm;
    }
  }
}

std::string Reason(ObjectContactStatus status) {
  return status == ObjectContactStatus::kNoTangency
             ? "the object meets an end of the front beam, not its side"
             : "no equilibrium found against this object";
}

bool IsSolved(const SolvedRow& row) {
  return row.status == ObjectContactStatus::kContact ||
         row.status == ObjectContactStatus::kNoContact;
}

SolvedRow SolveRow(const RowLoad& load, const Scene& scene,
                   EquilibriumSolver* solver) {
  // Every row starts from the unloaded finger, so that its result does not
  // depend on the rows before.
  solver->Reset();
  SolvedRow row;
  row.object = load.object.has_value();
  row.contacts = load.contacts;
  if (row.object) {
    const ObjectContact found = SolveObjectContact(
        *scene.object, *load.object, scene.friction_coefficient, solver);
    row.status = found.status;
    row.contacts = found.contacts;
    row.displacement_mm = found.displacement_mm;
    if (!IsSolved(row)) row.failure = Reason(row.status);
  } else if (solver->Solve(load.contacts)) {
    row.status = ObjectContactStatus::kContact;
  } else {
    row.failure = solver->Why();
  }
  if (IsSolved(row)) {
    row.outputs = solver->outputs();
    row.rib_tensions = solver->state().q.tail(solver->model().ribs());
    const Shape shape(*solver, row.contacts);
    for (const Rib& rib : solver->model().finger().ribs) {
      for (const Side side : {Side::kFront, Side::kBack}) {
        const Section at =
            shape.At(side, side == Side::kFront ? rib.front_mm : rib.back_mm);
        row.pins.emplace_back(at.x_mm, at.y_mm);
      }
    }
  }
  return row;
}

// Creates the columns to fill, empty, in the order of the output.
void AddColumns(const Finger& finger, int contacts, int object_contacts,
                bool displacement, FrameTable* frames) {
  std::vector<std::string> names;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    names.insert(names.end(), {GaugeVolts(j), GaugeAngle(j)});
  }
  for (int c = 0; c < contacts; ++c) {
    names.insert(names.end(), {ContactX(c), ContactY(c), ContactAngle(c)});
  }
  if (displacement) names.push_back(kDisplacement);
  for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
    names.push_back(RibForce(i));
  }
  for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      for (const char* axis : {"x", "y"}) {
        names.push_back(RibPin(i, SideName(side), axis));
      }
    }
  }
  names.insert(names.end(),
               {"force_N", "tip_x_mm", "tip_y_mm", "tip_angle_rad"});
  for (int c = 0; c < object_contacts; ++c) {
    // Other rows may give their loads in these columns, so they are kept.
    frames->MutableNumbers(ContactArc(c));
    frames->MutableNumbers(NormalForce(c));
  }
  for (const std::string& name : names) {
    frames->MutableNumbers(name).assign(frames->rows(), std::nan(""));
  }
  frames->MutableText("status").assign(frames->rows(), "");
}

// Fills in one solved row. Returns the force on the finger.
double FillRow(const Finger& finger, const SolvedRow& solved, bool displacement,
               std::size_t row, FrameTable* frames) {
  const auto set = [&](const std::string& name, double value) {
    frames->MutableNumbers(name)[row] = value;
  };
  const int gauges = static_cast<int>(finger.gauges.size());
  for (int j = 0; j < gauges; ++j) {
    const double angle = solved.outputs[j];
    set(GaugeAngle(j), angle);
    set(GaugeVolts(j), finger.gauges[j].Volts(angle));
  }
  if (solved.object && solved.contacts.empty()) set(NormalForce(0), 0);
  Eigen::Vector2d force(0, 0);
  for (int c = 0; c < static_cast<int>(solved.contacts.size()); ++c) {
    const PointContact& contact = solved.contacts[c];
    const Eigen::Vector3d pose = solved.outputs.segment<3>(gauges + 3 * c);
    if (solved.object) {
      set(ContactArc(c), contact.arc_mm);
      set(NormalForce(c), contact.normal_N);
    }
    set(ContactX(c), pose.x());
    set(ContactY(c), pose.y());
    set(ContactAngle(c), pose.z());
    force += ContactForce(contact, pose.z());
  }
  set("force_N", force.norm());
  if (displacement && solved.object) set(kDisplacement, solved.displacement_mm);
  for (int i = 0; i < solved.rib_tensions.size(); ++i) {
    set(RibForce(i), solved.rib_tensions[i]);
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Eigen::Vector2d& pin =
          solved.pins[2 * i + LadderModel::Index(side)];
      set(RibPin(i, SideName(side), "x"), pin.x());
      set(RibPin(i, SideName(side), "y"), pin.y());
    }
  }
  const Eigen::Vector3d tip = solved.outputs.tail<3>();
  set("tip_x_mm", tip.x());
  set("tip_y_mm", tip.y());
  set("tip_angle_rad", tip.z());
  return force.norm();
}

}  // namespace

SimulationSummary Simulate(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           FrameTable* frames, FrameTable* shapes) {
  const LoadReader loads(finger, scene, *frames);
  const std::size_t rows = frames->rows();
  // All loads are read first, so that a bad row is reported before any is
  // solved.
  std::vector<RowLoad> all;
  for (std::size_t row = 0; row < rows; ++row) all.push_back(loads.Read(row));
  if (shapes != nullptr) *shapes = FrameTable(rows * 202);
  std::size_t next_shape = 0;

  EquilibriumSolver solver(finger, discretization);
  std::vector<SolvedRow> solved;
  int object_contacts = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    solved.push_back(SolveRow(all[row], scene, &solver));
    const SolvedRow& now = solved.back();
    if (now.object) {
      object_contacts =
          std::max({object_contacts, 1, static_cast<int>(now.contacts.size())});
    }
    if (shapes != nullptr && IsSolved(now)) {
      AddShape(solver, now.contacts, row, shapes, &next_shape);
    }
  }
  if (shapes != nullptr) shapes->Truncate(next_shape);

  SimulationSummary summary;
  const bool displacement = object_contacts > 0 && scene.object->spring;
  AddColumns(finger, std::max(loads.contacts(), object_contacts),
             object_contacts, displacement, frames);
  for (std::size_t row = 0; row < rows; ++row) {
    std::string& status = frames->MutableText("status")[row];
    if (!IsSolved(solved[row])) {
      ++summary.not_converged;
      status = "not_converged";
      if (summary.first_failure.empty()) {
        summary.first_failure = frames->path() + ":" +
                                std::to_string(frames->line(row)) + ": " +
                                solved[row].failure;
      }
      continue;
    }
    const bool touches =
        FillRow(finger, solved[row], displacement, row, frames) > 0;
    ++(touches ? summary.contact : summary.free);
    status = touches ? "ok" : "no_contact";
  }
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

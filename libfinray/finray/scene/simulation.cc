#include "finray/scene/simulation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "finray/finger/geometry.h"
#include "finray/finger/point_contact.h"
#include "finray/io/error.h"
#include "finray/objects/object_contact.h"
#include "finray/scene/frame_columns.h"
#include "finray/statics/shape.h"

namespace finray {
namespace {

constexpr char kDisplacement[] = "object_displacement_mm";

// The load on the finger in one row of a frame table.
struct RowLoad {
  std::vector<PointContact> contacts;
  std::optional<ObjectPose> object;  // Set only if there are no contacts.
};

// Reads the loads of all rows. Throws InputError with the line of a load that
// is incomplete, negative or off the beam. `contacts` is the number of point
// contacts that the columns can hold.
std::vector<RowLoad> ReadLoads(const Finger& finger, const Scene& scene,
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
  std::vector<RowLoad> loads(table.rows());
  for (std::size_t row = 0; row < loads.size(); ++row) {
    RowLoad& load = loads[row];
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

// Fills in a row: NaN where there is no solution. Returns the force on the
// finger.
double FillRow(const Finger& finger, const SolvedRow& solved, int contacts,
               bool displacement, std::size_t row, FrameTable* frames) {
  const auto set = [&](const std::string& name, double value) {
    frames->MutableNumbers(name)[row] = value;
  };
  const bool is_solved = IsSolved(solved);
  const auto output = [&](Eigen::Index i) {
    return is_solved ? solved.outputs[i] : std::nan("");
  };
  const int gauges = static_cast<int>(finger.gauges.size());
  for (int j = 0; j < gauges; ++j) {
    set(GaugeVolts(j), finger.gauges[j].Volts(output(j)));
    set(GaugeAngle(j), output(j));
  }
  Eigen::Vector2d force(0, 0);
  const int touching = static_cast<int>(solved.contacts.size());
  for (int c = 0; c < contacts; ++c) {
    Eigen::Vector3d pose = Eigen::Vector3d::Constant(std::nan(""));
    if (is_solved && c < touching) {
      pose = solved.outputs.segment<3>(gauges + 3 * c);
      force += ContactForce(solved.contacts[c], pose.z());
    }
    set(ContactX(c), pose.x());
    set(ContactY(c), pose.y());
    set(ContactAngle(c), pose.z());
  }
  if (displacement) {
    set(kDisplacement,
        is_solved && solved.object ? solved.displacement_mm : std::nan(""));
  }
  const int ribs = static_cast<int>(finger.ribs.size());
  for (int i = 0; i < ribs; ++i) {
    set(RibForce(i), is_solved ? solved.rib_tensions[i] : std::nan(""));
  }
  for (int i = 0; i < ribs; ++i) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      Eigen::Vector2d pin = Eigen::Vector2d::Constant(std::nan(""));
      if (is_solved) pin = solved.pins[2 * i + LadderModel::Index(side)];
      set(RibPin(i, SideName(side), "x"), pin.x());
      set(RibPin(i, SideName(side), "y"), pin.y());
    }
  }
  set("force_N", is_solved ? force.norm() : std::nan(""));
  const Eigen::Index tip = solved.outputs.size() - 3;
  set("tip_x_mm", output(tip));
  set("tip_y_mm", output(tip + 1));
  set("tip_angle_rad", output(tip + 2));
  // Other rows may give their loads in these columns, so they are kept there.
  if (!is_solved || !solved.object) return force.norm();
  if (touching == 0) set(NormalForce(0), 0);
  for (int c = 0; c < touching; ++c) {
    set(ContactArc(c), solved.contacts[c].arc_mm);
    set(NormalForce(c), solved.contacts[c].normal_N);
  }
  return force.norm();
}

}  // namespace

SimulationSummary Simulate(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           FrameTable* frames, FrameTable* shapes) {
  const std::size_t rows = frames->rows();
  // All loads are read first, so that a bad row is reported before any is
  // solved.
  int contacts = 0;
  const std::vector<RowLoad> all = ReadLoads(finger, scene, *frames, &contacts);
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
  for (int c = 0; c < object_contacts; ++c) {
    frames->MutableNumbers(ContactArc(c));
    frames->MutableNumbers(NormalForce(c));
  }
  contacts = std::max(contacts, object_contacts);
  for (std::size_t row = 0; row < rows; ++row) {
    const bool touches =
        FillRow(finger, solved[row], contacts, displacement, row, frames) > 0;
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

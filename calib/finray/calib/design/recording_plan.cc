#include "finray/calib/design/recording_plan.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "finray/calib/analysis/predicted_frames.h"
#include "finray/calib/design/contact_accuracy.h"
#include "finray/calib/problem/median.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"
#include "finray/objects/circle_centre.h"
#include "finray/objects/object_contact.h"

namespace finray {
namespace {

// Heights in shares of l_0 and loads in shares of the largest force. A finger
// that is stiffer than drawn then stays below the limit.
constexpr double kLowest = 0.06, kHighest = 0.94;
constexpr double kLightest = 0.15, kHeaviest = 0.8;
constexpr double kRetreat_mm = 5;  // of a free row, from the finger at rest
constexpr int kErrorsPerDraw = 100;
constexpr double kFramesStep = 1.08;
// Fewer rows than this a free parameter leave residuals too few to show what is
// wrong with a recording.
constexpr std::size_t kRowsPerParameter = 2;

struct StagePlace {
  bool touches;
  Eigen::Vector2d object_mm;  // stage coordinates
  PlannedContact planned;
};

// One drawn finger: what each row tells of it, and how the region is sensed.
struct RecordingDraw {
  std::vector<std::string> parameters;       // names of the free ones
  std::vector<Eigen::MatrixXd> information;  // by row; empty: nothing
  std::vector<double> force_N;               // by row; NaN without
  Eigen::MatrixXd by_place, by_force;        // mean of g'g over the region
  double noise_mm2 = 0, noise_N2 = 0;
  double worst_mm2 = 0, worst_N2 = 0;
};

std::vector<StagePlace> Candidates(const KnownFinger& known, const Plan& plan,
                                   const RecordingLimits& limits,
                                   std::uint64_t seed, std::size_t count,
                                   const Discretization& discretization) {
  const double length = known.finger.front_length_mm;
  const double radius = *plan.scene.circle_radius_mm();
  const auto reached = [&](const Eigen::Vector2d& place) {
    return (place.array() >= limits.from_mm.array()).all() &&
           (place.array() <= limits.to_mm.array()).all();
  };
  Eigen::Vector2d rest = known.stage.FromS({-radius - kRetreat_mm, length / 2});
  rest.y() = std::clamp(rest.y(), limits.from_mm.y(), limits.to_mm.y());
  if (!reached(rest)) {
    throw InputError(FormatText(
        "the stage cannot leave the finger: free rows take object_x_mm %.4g, "
        "the limits are %.4g to %.4g mm",
        rest.x(), limits.from_mm.x(), limits.to_mm.x()));
  }
  EquilibriumSolver solver(known.finger, discretization);
  const ContactRange range{kLowest * length, kHighest * length,
                           kLightest * limits.force_max_N,
                           kHeaviest * limits.force_max_N};
  std::vector<StagePlace> places;
  for (const PlannedContact& contact :
       SpreadContacts(range, 10 * count, seed)) {
    if (places.size() == count) break;
    if (places.size() % kFreeEvery == 0) places.push_back({false, rest, {}});
    if (!contact.touches()) continue;
    solver.Reset();
    if (!solver.Solve({{contact.contact_mm, contact.normal_N,
                        plan.scene.friction_coefficient}})) {
      continue;
    }
    const Eigen::Vector2d place =
        known.stage.FromS(CircleCentre(solver.contact_pose(0), radius));
    if (reached(place)) places.push_back({true, place, contact});
  }
  if (std::none_of(places.begin(), places.end(),
                   [](const StagePlace& place) { return place.touches; })) {
    throw InputError(
        "the stage reaches no place where the finger touches within its "
        "limits; where is its origin?");
  }
  places.resize(std::min(places.size(), count));
  return places;
}

RecordingDraw Meet(const KnownFinger& drawn, const Plan& plan,
                   const std::vector<StagePlace>& places,
                   const RecordingLimits& limits, const RecordingTarget& target,
                   const Discretization& discretization) {
  RecordingDraw draw;
  draw.information.resize(places.size());
  draw.force_N.assign(places.size(), kNaN);
  const RigidObject circle{
      Outline(CircleOutline{*plan.scene.circle_radius_mm()}), {}};
  const double friction = plan.scene.friction_coefficient;
  EquilibriumSolver solver(drawn.finger, discretization);
  std::vector<PlannedContact> contacts;
  std::vector<std::size_t> row_of;
  for (std::size_t i = 0; i < places.size(); ++i) {
    PlannedContact met;
    if (places[i].touches) {
      solver.Reset();
      const ObjectContact found = SolveObjectContact(
          circle, {drawn.stage.InS(places[i].object_mm), 0}, friction, &solver);
      if (found.status == ObjectContactStatus::kContact) {
        met = {found.contacts[0].arc_mm, found.contacts[0].normal_N};
        draw.force_N[i] = met.normal_N;
        if (found.contacts.size() > 1 || met.normal_N > limits.force_max_N) {
          continue;
        }
      } else if (found.status != ObjectContactStatus::kNoContact) {
        continue;
      }
    }
    contacts.push_back(met);
    row_of.push_back(i);
  }
  const std::vector<double> heights = HeightsOf(target.from_mm, target.to_mm);
  for (const double height : heights) {
    contacts.push_back({height, target.normal_N});
  }
  const PlannedRecording recording(drawn.finger, plan, contacts,
                                   discretization);
  const CalibrationParameters& parameters = recording.problem().parameters();
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    draw.parameters.push_back(parameters.FreeParameter(k).name);
  }
  std::vector<double> reading_V;
  for (const Gauge& gauge : drawn.finger.gauges) {
    reading_V.push_back(gauge.noise_V);
  }
  const std::vector<double> more_noise_V =
      MoreNoise_V(recording.problem().finger(), 1, reading_V);
  std::size_t sensed_heights = 0;
  for (const PlannedRecording::Row& row : recording.rows()) {
    if (row.contact < row_of.size()) {
      draw.information[row_of[row.contact]] =
          row.at.reduced.transpose() * row.at.reduced;
      continue;
    }
    const std::optional<GaugedContact> sensed = SensedBy(row.at, more_noise_V);
    if (!sensed) {
      throw InputError("the finger has fewer than two gauges");
    }
    const Eigen::MatrixXd g = sensed->by_parameter;
    const auto add = [](Eigen::MatrixXd* sum, const Eigen::RowVectorXd& by) {
      if (sum->size() == 0) sum->setZero(by.size(), by.size());
      *sum += by.transpose() * by;
    };
    add(&draw.by_place, g.row(0));
    add(&draw.by_force, g.row(1));
    draw.noise_mm2 += sensed->noise(0, 0);
    draw.noise_N2 += sensed->noise(1, 1);
    draw.worst_mm2 = std::max(draw.worst_mm2, sensed->noise(0, 0));
    draw.worst_N2 = std::max(draw.worst_N2, sensed->noise(1, 1));
    ++sensed_heights;
  }
  if (sensed_heights == 0) {
    throw InputError("the finger does not carry the force of the target");
  }
  const auto count = static_cast<double>(sensed_heights);
  draw.by_place /= count;
  draw.by_force /= count;
  draw.noise_mm2 /= count;
  draw.noise_N2 /= count;
  return draw;
}

// The rms errors of place and force of draws and recordings, after n rows.
struct PredictedErrors {
  std::vector<double> place_mm, force_N;

  double Met(const RecordingTarget& target) const {
    return Met(target, 0, place_mm.size());
  }
  // The same of one draw.
  double MetBy(std::size_t draw, const RecordingTarget& target) const {
    return Met(target, draw * kErrorsPerDraw, kErrorsPerDraw);
  }

 private:
  double Met(const RecordingTarget& target, std::size_t first,
             std::size_t count) const {
    double met = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      met += (!target.place_mm || place_mm[i] <= *target.place_mm) &&
             (!target.force_N || force_N[i] <= *target.force_N);
    }
    return met / static_cast<double>(count);
  }
};

// Returns the information on a draw after n rows, each recorded `times` times.
Eigen::MatrixXd InformationAfter(std::size_t rows, double times,
                                 const KnownFinger& known,
                                 const RecordingDraw& draw) {
  Eigen::MatrixXd information = known.information;
  for (std::size_t i = 0; i < rows; ++i) {
    if (draw.information[i].size() > 0) {
      information += times * draw.information[i];
    }
  }
  return information;
}

PredictedErrors ErrorsAfter(std::size_t rows, const KnownFinger& known,
                            const std::vector<RecordingDraw>& draws,
                            double times = 1) {
  PredictedErrors errors;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  for (const RecordingDraw& draw : draws) {
    const Eigen::MatrixXd root =
        Eigen::LLT<Eigen::MatrixXd>(
            BoundedCovariance(InformationAfter(rows, times, known, draw)))
            .matrixL();
    for (int k = 0; k < kErrorsPerDraw; ++k) {
      const Eigen::VectorXd d =
          root * Eigen::VectorXd::NullaryExpr(root.cols(), [&](Eigen::Index) {
            return normal(generator);
          });
      errors.place_mm.push_back(
          std::sqrt(draw.noise_mm2 + d.dot(draw.by_place * d)));
      errors.force_N.push_back(
          std::sqrt(draw.noise_N2 + d.dot(draw.by_force * d)));
    }
  }
  return errors;
}

// Returns the parameter that moves most along the direction in which what is
// unknown of the finger moves places or forces most.
std::string LeastKnown(const Eigen::MatrixXd& information,
                       const RecordingDraw& draw,
                       const RecordingTarget& target) {
  const Eigen::MatrixXd root =
      Eigen::LLT<Eigen::MatrixXd>(BoundedCovariance(information)).matrixL();
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(root.rows(), root.cols());
  if (target.place_mm) errors += draw.by_place / std::pow(*target.place_mm, 2);
  if (target.force_N) errors += draw.by_force / std::pow(*target.force_N, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.transpose() *
                                                             errors * root);
  Eigen::Index most = 0;
  (root * eigen.eigenvectors().rightCols<1>()).cwiseAbs().maxCoeff(&most);
  return draw.parameters[static_cast<std::size_t>(most)];
}

// Says that the finger touches within the limits in less than half of the rows.
bool IsOutOfReach(const RecordingDraw& draw,
                  const std::vector<StagePlace>& places) {
  int planned = 0, told = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    planned += places[i].touches;
    told += places[i].touches && draw.information[i].size() > 0;
  }
  return 2 * told < planned;
}

RecordingShortfall ShortfallOf(const std::vector<StagePlace>& places,
                               const KnownFinger& known,
                               const RecordingTarget& target,
                               const std::vector<RecordingDraw>& draws) {
  RecordingShortfall result;
  result.draws = static_cast<int>(draws.size());
  const auto errors_with = [&](int times) {
    return ErrorsAfter(places.size(), known, draws, times);
  };
  PredictedErrors errors = errors_with(RecordingShortfall::kMostTimes);
  result.met = errors.Met(target);
  if (result.met >= target.confidence) {
    int times = 2;
    while (times < RecordingShortfall::kMostTimes &&
           errors_with(times).Met(target) < target.confidence) {
      times *= 2;
    }
    result.rows = static_cast<std::size_t>(times) * places.size();
    return result;
  }
  std::map<std::string, int> unknown;
  for (std::size_t k = 0; k < draws.size(); ++k) {
    if (errors.MetBy(k, target) >= target.confidence) continue;
    const RecordingDraw& draw = draws[k];
    ++result.missing;
    if (std::sqrt(draw.noise_mm2) > target.place_mm.value_or(INFINITY) ||
        std::sqrt(draw.noise_N2) > target.force_N.value_or(INFINITY)) {
      ++result.noisy;
    } else if (IsOutOfReach(draw, places)) {
      ++result.out_of_reach;
    } else {
      ++unknown[LeastKnown(
          InformationAfter(places.size(), RecordingShortfall::kMostTimes, known,
                           draw),
          draw, target)];
    }
  }
  const auto most = std::max_element(
      unknown.begin(), unknown.end(),
      [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != unknown.end()) result.parameter = most->first;
  return result;
}

// Contacts in random order; free rows stay between them, and one ends the
// recording.
std::vector<StagePlace> Shuffled(std::vector<StagePlace> places,
                                 std::uint64_t seed) {
  std::vector<std::size_t> touching;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].touches) touching.push_back(i);
  }
  std::mt19937_64 generator(seed);
  for (std::size_t i = touching.size(); i > 1; --i) {
    std::swap(places[touching[i - 1]], places[touching[generator() % i]]);
  }
  if (places.back().touches) places.push_back(places.front());
  return places;
}

}  // namespace

RecordingPlan PlanRecording(const KnownFinger& known, const Plan& plan,
                            const RecordingLimits& limits,
                            const RecordingTarget& target, std::uint64_t seed,
                            std::size_t most_frames,
                            const Discretization& discretization) {
  if (!plan.scene.circle_radius_mm()) {
    throw InputError(
        "the plan's scene needs an object {shape: circle, radius_mm: ...}: a "
        "calibration measures the place of no other shape");
  }
  // The last row is a free one.
  const std::vector<StagePlace> places =
      Candidates(known, plan, limits, seed, most_frames - 1, discretization);
  std::vector<RecordingDraw> draws;
  for (int k = 0; k < kRecordingDraws; ++k) {
    const KnownFinger drawn =
        DrawFrom(known, plan, seed * 1000 + static_cast<std::uint64_t>(k),
                 discretization);
    draws.push_back(Meet(drawn, plan, places, limits, target, discretization));
  }
  RecordingPlan result;
  result.met_before = ErrorsAfter(0, known, draws).Met(target);
  const std::size_t least =
      kRowsPerParameter * static_cast<std::size_t>(known.information.rows());
  std::size_t rows = 0;
  PredictedErrors errors = ErrorsAfter(rows, known, draws);
  while (errors.Met(target) < target.confidence && rows < places.size()) {
    rows = rows == 0 ? least
                     : std::max(rows + 1,
                                static_cast<std::size_t>(kFramesStep * rows));
    rows = std::min(rows, places.size());
    errors = ErrorsAfter(rows, known, draws);
  }
  result.met = errors.Met(target);
  result.suffices = result.met >= target.confidence;
  if (!result.suffices) {
    result.shortfall = ShortfallOf(places, known, target, draws);
  }
  result.median_mm = Median(errors.place_mm);
  result.median_N = Median(errors.force_N);
  const auto median = [&](double RecordingDraw::*variance) {
    std::vector<double> std;
    for (const RecordingDraw& draw : draws) {
      std.push_back(std::sqrt(draw.*variance));
    }
    return Median(std);
  };
  result.noise_mm = median(&RecordingDraw::noise_mm2);
  result.noise_N = median(&RecordingDraw::noise_N2);
  result.worst_mm = median(&RecordingDraw::worst_mm2);
  result.worst_N = median(&RecordingDraw::worst_N2);
  result.largest_N = 0;
  if (rows == 0) return result;

  // The range of forces goes with its place through the shuffle.
  std::vector<StagePlace> chosen(places.begin(),
                                 places.begin() + static_cast<long>(rows));
  EquilibriumSolver solver(known.finger, discretization);
  for (const StagePlace& place : Shuffled(chosen, seed)) {
    RecordingRow row{place.touches, place.object_mm, kNaN, 0, 0, 0, {}};
    solver.Reset();
    std::vector<PointContact> contacts;
    if (place.touches) {
      contacts.push_back({place.planned.contact_mm, place.planned.normal_N,
                          plan.scene.friction_coefficient});
      row.contact_mm = place.planned.contact_mm;
      row.force_N = row.force_low_N = row.force_high_N = place.planned.normal_N;
      const auto index = static_cast<std::size_t>(
          std::find_if(places.begin(), places.end(),
                       [&](const StagePlace& other) {
                         return other.touches &&
                                other.object_mm == place.object_mm;
                       }) -
          places.begin());
      for (const RecordingDraw& draw : draws) {
        const double force =
            std::isnan(draw.force_N[index]) ? 0 : draw.force_N[index];
        row.force_low_N = std::min(row.force_low_N, force);
        row.force_high_N = std::max(row.force_high_N, force);
      }
      result.largest_N = std::max(result.largest_N, row.force_high_N);
    }
    solver.Solve(contacts);
    for (std::size_t j = 0; j < known.finger.gauges.size(); ++j) {
      row.gauges_V.push_back(known.finger.gauges[j].Volts(
          solver.gauge_angle(static_cast<int>(j))));
    }
    result.rows.push_back(row);
  }
  return result;
}

}  // namespace finray

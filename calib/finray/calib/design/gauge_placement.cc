#include "finray/calib/design/gauge_placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "finray/calib/design/contact_accuracy.h"
#include "finray/finger/gauge_play.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

constexpr int kPlacementStarts = 80;
constexpr std::size_t kMostPlacements = 20;
constexpr int kLengths = 4;  // between the least and the most

// One gauge on each mm of both beams: the bending angle between any two of
// their ends is a sum of theirs.
Finger Tiled(Finger finger, Side side) {
  finger.calibration.reset();
  finger.gauges.clear();
  const int count = static_cast<int>(std::floor(BeamLength(finger, side)));
  for (int i = 0; i < count; ++i) {
    Gauge tile;
    tile.beam = side;
    tile.start_mm = i;
    tile.length_mm = 1;
    finger.gauges.push_back(tile);
  }
  return finger;
}

}  // namespace

// Row s is of the bending angle between 0 and s mm under a contact at each
// height: the angle itself, and its derivatives by (l_c, f_c), two columns a
// height.
struct GaugePlaces::Bending {
  Eigen::MatrixXd angle, slope;
};

GaugePlaces::Bending GaugePlaces::BendingOf(
    const Finger& finger, const PlacementTask& task, Side side,
    const std::vector<double>& heights, const Discretization& discretization) {
  EquilibriumSolver solver(Tiled(finger, side), discretization);
  const int tiles = solver.model().gauges();
  const auto count = static_cast<Eigen::Index>(heights.size());
  Bending sum{Eigen::MatrixXd::Zero(tiles + 1, count),
              Eigen::MatrixXd::Zero(tiles + 1, 2 * count)};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    solver.Reset();
    if (!solver.SolveWithSensitivities(
            {{heights[i], task.normal_N, task.friction}})) {
      throw InputError(FormatText("the finger does not carry %g N at %g mm: %s",
                                  task.normal_N, heights[i],
                                  solver.Why().c_str()));
    }
    for (int s = 0; s < tiles; ++s) {
      const auto at = static_cast<Eigen::Index>(i);
      sum.angle(s + 1, at) = sum.angle(s, at) + solver.gauge_angle(s);
      sum.slope.block<1, 2>(s + 1, 2 * at) =
          sum.slope.block<1, 2>(s, 2 * at) +
          solver.d_outputs().block<1, 2>(s, 0);
    }
  }
  return sum;
}

GaugePlaces::GaugePlaces(const Finger& finger, const PlacementTask& task,
                         const Discretization& discretization)
    : goal_(task.goal), clearance_mm_(task.clearance_mm) {
  const std::vector<double> heights = HeightsOf(task.from_mm, task.to_mm);
  std::vector<int> lengths;
  for (int i = 0; i <= kLengths; ++i) {
    lengths.push_back(static_cast<int>(std::lround(
        task.least_length_mm +
        (task.most_length_mm - task.least_length_mm) * i / kLengths)));
  }
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  for (const Side side : task.beams) {
    const Bending bending =
        BendingOf(finger, task, side, heights, discretization);
    for (const int length : lengths) {
      Add(finger, task, side, length, bending);
    }
  }
  if (gauges_.empty()) {
    throw InputError(FormatText(
        "no gauge of %d mm has room between hinges with a clearance of %g mm",
        lengths.front(), clearance_mm_));
  }
}

void GaugePlaces::Add(const Finger& finger, const PlacementTask& task,
                      Side side, int length_mm, const Bending& bending) {
  const double beam_mm = BeamLength(finger, side);
  for (int start = 0; start + length_mm < bending.slope.rows(); ++start) {
    const double end = start + length_mm;
    const bool free = std::all_of(
        finger.ribs.begin(), finger.ribs.end(), [&](const Rib& rib) {
          const double hinge = HingePlace(rib, side);
          return hinge <= start - clearance_mm_ || hinge >= end + clearance_mm_;
        });
    if (!free || start < clearance_mm_ || end > beam_mm - clearance_mm_) {
      continue;
    }
    Gauge gauge = task.gauge;
    gauge.beam = side;
    gauge.start_mm = start;
    gauge.length_mm = length_mm;
    gauge.gain_V_per_rad *= task.gauge.length_mm / length_mm;
    const Eigen::RowVectorXd slope =
        bending.slope.row(start + length_mm) - bending.slope.row(start);
    Eigen::Matrix2Xd feel =
        gauge.AngleWeight() *
        Eigen::Map<const Eigen::Matrix2Xd>(slope.data(), 2, slope.size() / 2);
    for (Eigen::Index i = 0; gauge.hysteresis_rad > 0 && i < feel.cols(); ++i) {
      const double play_rad =
          PlayStd(gauge.hysteresis_rad, bending.angle(start + length_mm, i) -
                                            bending.angle(start, i));
      feel.col(i) /= std::hypot(1, gauge.AngleWeight() * play_rad);
    }
    gauges_.push_back(gauge);
    feels_.push_back(feel);
  }
}

bool GaugePlaces::MayBeTogether(int a, int b) const {
  const Gauge &one = gauges_[a], &two = gauges_[b];
  return one.beam != two.beam ||
         one.start_mm + one.length_mm + clearance_mm_ <= two.start_mm ||
         two.start_mm + two.length_mm + clearance_mm_ <= one.start_mm;
}

double GaugePlaces::WorstStd(const std::vector<int>& places) const {
  double worst = 0;
  for (Eigen::Index i = 0; i < feels_[0].cols(); ++i) {
    double ll = 0, lf = 0, ff = 0;
    for (const int place : places) {
      const auto feel = feels_[place].col(i);
      ll += feel[0] * feel[0];
      lf += feel[0] * feel[1];
      ff += feel[1] * feel[1];
    }
    const double determinant = ll * ff - lf * lf;
    if (!(determinant > 1e-12 * ll * ff)) {
      return std::numeric_limits<double>::infinity();
    }
    worst = std::max(worst,
                     (goal_ == PlacementGoal::kPlace ? ff : ll) / determinant);
  }
  return std::sqrt(worst);
}

std::vector<Placement> PlaceGauges(const GaugePlaces& places, int count,
                                   std::uint64_t seed) {
  const int all = static_cast<int>(places.size());
  std::mt19937_64 generator(seed);
  std::vector<std::pair<double, std::vector<int>>> found;
  for (int start = 0; start < kPlacementStarts; ++start) {
    std::vector<int> order(all);
    for (int i = 0; i < all; ++i) order[i] = i;
    // std::shuffle differs between standard libraries.
    for (int i = all - 1; i > 0; --i) {
      std::swap(order[i], order[generator() % (i + 1)]);
    }
    const auto fits = [&](const std::vector<int>& chosen, int place,
                          std::size_t besides) {
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        if (k != besides && !places.MayBeTogether(chosen[k], place)) {
          return false;
        }
      }
      return true;
    };
    std::vector<int> chosen;
    for (const int place : order) {
      if (static_cast<int>(chosen.size()) == count) break;
      if (fits(chosen, place, chosen.size())) chosen.push_back(place);
    }
    if (static_cast<int>(chosen.size()) < count) continue;
    double best = places.WorstStd(chosen);
    for (bool better = true; better;) {
      better = false;
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        for (int place = 0; place < all; ++place) {
          if (place == chosen[k] || !fits(chosen, place, k)) continue;
          std::vector<int> tried = chosen;
          tried[k] = place;
          const double std = places.WorstStd(tried);
          if (std < best * (1 - 1e-9)) {
            best = std;
            chosen = tried;
            better = true;
          }
        }
      }
    }
    std::sort(chosen.begin(), chosen.end());
    found.emplace_back(best, chosen);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  if (found.size() > kMostPlacements) found.resize(kMostPlacements);
  std::vector<Placement> placements;
  for (const auto& [std, chosen] : found) {
    Placement placement{{}, std};
    for (const int place : chosen) {
      placement.gauges.push_back(places.gauge(place));
    }
    std::sort(placement.gauges.begin(), placement.gauges.end(),
              [](const Gauge& a, const Gauge& b) {
                return a.beam != b.beam ? a.beam > b.beam
                                        : a.start_mm < b.start_mm;
              });
    placements.push_back(placement);
  }
  return placements;
}

}  // namespace finray

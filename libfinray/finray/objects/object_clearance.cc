#include "finray/objects/object_clearance.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// At this density a bend of the front beam spans tens of samples.
constexpr int kSamples = 280;
constexpr int kBisections = 50;

struct Sample {
  double arc;
  double distance;
  double slope;  // by arc length
};

std::vector<double> SampleArcs(double length_mm,
                               const std::vector<PointContact>& contacts) {
  std::vector<double> arcs;
  for (const PointContact& contact : contacts) arcs.push_back(contact.arc_mm);
  std::sort(arcs.begin(), arcs.end());
  for (std::size_t c = 1; c < contacts.size(); ++c) {
    arcs.push_back(0.5 * (arcs[c - 1] + arcs[c]));
  }
  for (int i = 0; i <= kSamples; ++i) {
    arcs.push_back(length_mm * i / kSamples);
  }
  std::sort(arcs.begin(), arcs.end());
  arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
  return arcs;
}

}  // namespace

std::vector<Approach> FindApproaches(const Shape& shape, double length_mm,
                                     const std::vector<PointContact>& contacts,
                                     const Outline& outline,
                                     const ObjectPose& pose, double below_mm) {
  const auto sample = [&](double arc) -> Sample {
    const Section at = shape.At(Side::kFront, arc);
    const Outline::Distance distance =
        outline.DistanceOf({at.x_mm, at.y_mm}, pose);
    return {arc, distance.distance_mm,
            distance.normal.x() * std::cos(at.theta_rad) +
                distance.normal.y() * std::sin(at.theta_rad)};
  };
  std::vector<Sample> samples;
  double least = HUGE_VAL;
  for (const double arc : SampleArcs(length_mm, contacts)) {
    samples.push_back(sample(arc));
    least = std::min(least, samples.back().distance);
  }
  // A minimum is at most one spacing lower than the samples beside it.
  const double cut = std::max(least, below_mm + length_mm / kSamples);
  std::vector<Approach> approaches;
  const std::size_t last = samples.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const Sample& here = samples[i];
    const Sample& before = samples[i > 0 ? i - 1 : 0];
    const Sample& after = samples[std::min(i + 1, last)];
    if (here.distance > cut) continue;
    // Among equal neighbours the first one counts.
    if (i > 0 && before.distance <= here.distance) continue;
    if (after.distance < here.distance) continue;
    if ((i == 0 && here.slope >= 0) || (i == last && here.slope <= 0)) {
      approaches.push_back({here.arc, here.distance, true});
      continue;
    }
    double arc = here.arc;
    if (before.slope < 0 && after.slope > 0) {
      double low = before.arc, high = after.arc;
      for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (low + high);
        (sample(middle).slope < 0 ? low : high) = middle;
      }
      arc = 0.5 * (low + high);
    }
    // In a rigid chain points lie on chords while angles turn evenly, so the
    // root of the slope may not be the lowest point.
    const double refined = sample(arc).distance;
    if (refined > here.distance) arc = here.arc;
    approaches.push_back({arc, std::min(refined, here.distance), false});
    least = std::min(least, refined);
  }
  approaches.erase(std::remove_if(approaches.begin(), approaches.end(),
                                  [&](const Approach& a) {
                                    return a.distance_mm > below_mm &&
                                           a.distance_mm > least;
                                  }),
                   approaches.end());
  return approaches;
}

}  // namespace finray

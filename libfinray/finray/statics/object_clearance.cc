#include "finray/statics/object_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace finray {
namespace {

// At this density a bend of the front beam spans tens of samples.
constexpr int kSamples = 280;
constexpr int kBisections = 50;

struct Sample {
  double distance;
  double slope;  // by arc length
};

}  // namespace

std::vector<Approach> FindApproaches(const Shape& shape, double length_mm,
                                     const Outline& outline,
                                     const ObjectPose& pose, double below_mm) {
  const auto sample = [&](double arc) -> Sample {
    const Section at = shape.At(Side::kFront, arc);
    const Outline::Distance distance =
        outline.DistanceOf({at.x_mm, at.y_mm}, pose);
    return {distance.distance_mm,
            distance.normal.x() * std::cos(at.theta_rad) +
                distance.normal.y() * std::sin(at.theta_rad)};
  };
  const auto arc_of = [&](int i) { return length_mm * i / kSamples; };

  std::array<Sample, kSamples + 1> samples;
  double least = samples[0].distance = HUGE_VAL;
  for (int i = 0; i <= kSamples; ++i) {
    samples[i] = sample(arc_of(i));
    least = std::min(least, samples[i].distance);
  }
  // A minimum lies at most one spacing below a sample beside it.
  const double cut = std::max(least, below_mm + length_mm / kSamples);
  std::vector<Approach> approaches;
  for (int i = 0; i <= kSamples; ++i) {
    if (samples[i].distance > cut) continue;
    // Of equal neighbours the first counts.
    if (i > 0 && samples[i - 1].distance <= samples[i].distance) continue;
    if (i < kSamples && samples[i + 1].distance < samples[i].distance) continue;
    const int before = std::max(i - 1, 0), after = std::min(i + 1, kSamples);
    if (i == 0 && samples[0].slope >= 0) {
      approaches.push_back({0, samples[0].distance, true});
    } else if (i == kSamples && samples[i].slope <= 0) {
      approaches.push_back({length_mm, samples[i].distance, true});
    } else {
      double arc = arc_of(i);
      if (samples[before].slope < 0 && samples[after].slope > 0) {
        double low = arc_of(before), high = arc_of(after);
        for (int k = 0; k < kBisections; ++k) {
          const double middle = 0.5 * (low + high);
          (sample(middle).slope < 0 ? low : high) = middle;
        }
        arc = 0.5 * (low + high);
      }
      approaches.push_back({arc, sample(arc).distance, false});
    }
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

#include "finray/objects/approaches.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// At this density a bend of the front beam spans tens of samples.
constexpr int kSamples = 280;
constexpr int kMostSecants = 60;
// The surface moves |1 + strain + kappa h| per arc length, h being its height
// over the beam. Up to |kappa h| = 1, where it would fold over itself, that is
// at most this, and a distance changes no faster.
constexpr double kFastest = 2;
constexpr double kFound = 1e-14;  // of l_0

struct Sample {
  double arc;
  double distance;
  double slope;  // by arc length
};

std::vector<double> SampleArcs(double length_mm,
                               const std::vector<PointContact>& contacts) {
  std::vector<double> own;
  for (const PointContact& contact : contacts) own.push_back(contact.arc_mm);
  std::sort(own.begin(), own.end());
  for (std::size_t c = 1; c < contacts.size(); ++c) {
    own.push_back(0.5 * (own[c - 1] + own[c]));
  }
  std::sort(own.begin(), own.end());
  std::vector<double> arcs(kSamples + 1);
  for (int i = 0; i <= kSamples; ++i) arcs[i] = length_mm * i / kSamples;
  for (const double arc : own) {
    const auto place = std::lower_bound(arcs.begin(), arcs.end(), arc);
    if (place == arcs.end() || *place != arc) arcs.insert(place, arc);
  }
  return arcs;
}

// The distance of the front beam at given arcs, of which only those are
// evaluated that may count.
class SampledDistance {
 public:
  SampledDistance(const Shape& shape, const Outline& outline,
                  const ObjectPose& pose, const std::vector<double>& arcs)
      : shape_(shape), outline_(outline), pose_(pose) {
    samples_.reserve(arcs.size());
    for (const double arc : arcs) samples_.push_back({arc, kUnknown, 0});
  }

  Sample Take(double arc) const {
    const Section at = shape_.SurfaceAt(Side::kFront, arc);
    const Outline::Distance distance =
        outline_.DistanceOf({at.x_mm, at.y_mm}, pose_);
    return {arc, distance.distance_mm,
            distance.normal.x() * std::cos(at.theta_rad) +
                distance.normal.y() * std::sin(at.theta_rad)};
  }
  std::size_t last() const { return samples_.size() - 1; }
  const Sample& At(std::size_t i) {
    Sample& sample = samples_[i];
    if (sample.distance == kUnknown) {
      sample = Take(sample.arc);
      least_ = std::min(least_, sample.distance);
    }
    return sample;
  }
  double least() const { return least_; }

  // Evaluates all samples that lie below both `cut` and the least so far, by
  // halving the stretches that bounds do not exclude. The others stay further
  // away than any sample that counts.
  void TakeBelow(double cut) {
    At(0);
    At(last());
    Halve(0, last(), cut);
  }
  bool Taken(std::size_t i) const { return samples_[i].distance != kUnknown; }

 private:
  static constexpr double kUnknown = HUGE_VAL;

  void Halve(std::size_t low, std::size_t high, double cut) {
    if (high - low < 2) return;
    const Sample &a = samples_[low], &b = samples_[high];
    const double bound =
        0.5 * (a.distance + b.distance - kFastest * (b.arc - a.arc));
    if (bound > std::max(least_, cut)) return;
    const std::size_t middle = (low + high) / 2;
    At(middle);
    Halve(low, middle, cut);
    Halve(middle, high, cut);
  }

  const Shape& shape_;
  const Outline& outline_;
  const ObjectPose& pose_;
  std::vector<Sample> samples_;
  double least_ = HUGE_VAL;
};

// The zero of the slope between two samples, where it grows through zero, by
// regula falsi with Illinois' weights. It ends when the distance cannot change
// by more than `tolerance_mm`.
double LowestArc(const SampledDistance& distance, Sample low, Sample high,
                 double tolerance_mm) {
  double weighted_low = low.slope, weighted_high = high.slope;
  int kept = 0;  // the end that stayed in the last step
  for (int i = 0; i < kMostSecants; ++i) {
    const Sample here =
        distance.Take(low.arc - weighted_low * (high.arc - low.arc) /
                                    (weighted_high - weighted_low));
    if (std::abs(here.slope) * (high.arc - low.arc) < tolerance_mm) {
      return here.arc;
    }
    const bool lower = here.slope < 0;
    (lower ? low : high) = here;
    (lower ? weighted_low : weighted_high) = here.slope;
    if (kept == (lower ? 1 : -1)) (lower ? weighted_high : weighted_low) /= 2;
    kept = lower ? 1 : -1;
  }
  return 0.5 * (low.arc + high.arc);
}

}  // namespace

std::vector<Approach> FindApproaches(const Shape& shape, double length_mm,
                                     const std::vector<PointContact>& contacts,
                                     const Outline& outline,
                                     const ObjectPose& pose, double below_mm) {
  SampledDistance samples(shape, outline, pose,
                          SampleArcs(length_mm, contacts));
  // A minimum is at most one spacing lower than the samples beside it.
  const double spaced = below_mm + length_mm / kSamples;
  samples.TakeBelow(spaced);
  double least = samples.least();
  const double cut = std::max(least, spaced);
  std::vector<Approach> approaches;
  const std::size_t last = samples.last();
  for (std::size_t i = 0; i <= last; ++i) {
    if (!samples.Taken(i) || samples.At(i).distance > cut) continue;
    const Sample& here = samples.At(i);
    const Sample& before = samples.At(i > 0 ? i - 1 : 0);
    const Sample& after = samples.At(std::min(i + 1, last));
    // Among equal neighbours the first one counts.
    if (i > 0 && before.distance <= here.distance) continue;
    if (after.distance < here.distance) continue;
    if ((i == 0 && here.slope >= 0) || (i == last && here.slope <= 0)) {
      approaches.push_back({here.arc, here.distance, true});
      continue;
    }
    double arc = here.arc;
    if (before.slope < 0 && after.slope > 0) {
      const bool rising = here.slope > 0;
      const Sample& low = rising ? before : here;
      const Sample& high = rising ? here : after;
      arc = LowestArc(samples, low, high, kFound * length_mm);
    }
    // In a rigid chain points lie on chords while angles turn evenly, so the
    // root of the slope may not be the lowest point.
    const double refined = samples.Take(arc).distance;
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

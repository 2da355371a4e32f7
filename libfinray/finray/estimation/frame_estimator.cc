#include "finray/estimation/frame_estimator.h"

#include <algorithm>
#include <cmath>

#include "finray/estimation/smoothing.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"

namespace finray {
namespace {

constexpr int kUnknowns = FrameEstimator::kUnknowns;

void CopyContacts(const ContactSolution& from, ContactEstimates* to) {
  for (int c = 0; c < from.count; ++c) {
    (*to)[c].arc_mm = from.contacts[c].arc_mm;
    (*to)[c].normal_N = from.contacts[c].normal_N;
    (*to)[c].pose = from.poses[c];
  }
}

void CheckScene(const Finger& finger, const Scene& scene) {
  RefuseBackContacts(scene);
  const int contacts = scene.contacts.value_or(1);
  if (contacts > kFittedContacts) {
    throw InputError("scene: " + std::to_string(contacts) +
                     " contacts cannot be estimated; 0, 1, 2 and auto can");
  }
  const auto gauges = static_cast<int>(finger.gauges.size());
  if (gauges == 0) {
    throw InputError("finger '" + finger.name +
                     "' has no gauges to estimate from");
  }
  if (scene.object_std_mm && (!scene.circle_radius_mm() || contacts != 1)) {
    throw InputError(
        "scene: a measured object needs a circle and one contact or auto");
  }
  const int needed = contacts > 0 ? kUnknowns : 0;
  if (gauges + (scene.object_std_mm ? 2 : 0) < needed) {
    throw InputError("scene: a contact needs at least 2 gauges, finger '" +
                     finger.name + "' has " + std::to_string(gauges));
  }
  if (contacts == 2 && gauges < 2 * kUnknowns) {
    throw InputError("scene: 2 contacts need at least 4 gauges, finger '" +
                     finger.name + "' has " + std::to_string(gauges));
  }
}

}  // namespace

FrameEstimator::FrameEstimator(const Finger& finger, const Scene& scene,
                               const Discretization& discretization,
                               FrameMethod method)
    : setup_{(CheckScene(finger, scene), finger), scene, discretization,
             method},
      search_(finger, scene, discretization, method),
      systematic_(finger, scene, discretization),
      free_(FreeEstimate(finger, discretization)) {
  if (scene.gauge_offset_walk) {
    live_.offsets.emplace(finger, *scene.gauge_offset_walk,
                          search_.table().free_angles());
  }
  setup_.scene.gauge_offset_walk.reset();
}

FrameEstimator::FrameEstimator(const FrameEstimator& other)
    : setup_(other.setup_),
      search_(setup_.finger, setup_.scene, setup_.discretization, setup_.method,
              other.search_.tables()),
      systematic_(other.systematic_),
      free_(other.free_) {
  live_.offsets = other.live_.offsets;
  if (live_.offsets) live_.offsets->Restart();
}

std::unique_ptr<FrameEstimator> FrameEstimator::ForAnotherThread() const {
  return std::unique_ptr<FrameEstimator>(new FrameEstimator(*this));
}

std::unique_ptr<FrameEstimator> FrameEstimator::WithErrorsOf(
    const ParameterCovariance& calibration) const {
  auto other = ForAnotherThread();
  other->setup_.finger.calibration = calibration;
  if (!other->systematic_.empty()) other->systematic_.SetErrors(calibration);
  return other;
}

double FrameEstimator::LeastForce_N(const Finger& finger) {
  return std::min(kLeastForce_N, kLeastForce * ForceUnit(finger));
}

FrameEstimate FrameEstimator::FreeEstimate(
    const Finger& finger, const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  solver.Solve({});
  FrameEstimate free;
  free.status = FrameStatus::kNoContact;
  free.contact[0].normal_N = 0;
  free.tip_pose = solver.tip_pose();
  for (int i = 0; i < solver.model().ribs(); ++i) {
    free.rib_tension_N.push_back(solver.rib_tension(i));
  }
  return free;
}

FrameEstimate FrameEstimator::Estimate(const Measurements& readings) {
  if (Slides(readings)) return EstimateSliding(readings);
  return EstimateAlone(readings);
}

// Says whether the object's motion makes friction another than the scene's.
bool FrameEstimator::Slides(const Measurements& readings) const {
  constexpr double kSame = 1e-3;  // of the coefficient
  const double friction = setup_.scene.friction_coefficient;
  return std::abs(readings.FrictionOr(friction) - friction) >
         kSame * std::abs(friction);
}

// Friction that pulls the other way has tables of its own.
FrameEstimate FrameEstimator::EstimateSliding(const Measurements& readings) {
  const double friction = setup_.scene.friction_coefficient;
  FrameEstimator* way = this;
  if (readings.friction * friction < 0) {
    if (!reversed_) {
      Scene scene = setup_.scene;
      scene.friction_coefficient = -friction;
      reversed_ = std::make_unique<FrameEstimator>(
          WithFrictionReversed(setup_.finger), scene, setup_.discretization,
          setup_.method);
    }
    way = reversed_.get();
  }
  way->search_.set_friction(readings.friction);
  FrameEstimate estimate = way->EstimateAlone(readings);
  estimate.friction = readings.friction;
  way->search_.set_friction(way->setup_.scene.friction_coefficient);
  return estimate;
}

FrameEstimate FrameEstimator::EstimateAlone(const Measurements& readings) {
  FrameEstimate estimate;
  PackAll(&readings, 1);
  search_.Forget();
  Explain(readings, packed_[0], &estimate);
  search_.Forget();
  Judge(readings, packed_[0], &estimate);
  return estimate;
}

void FrameEstimator::EstimateBlock(const Measurements* readings,
                                   std::size_t count,
                                   FrameEstimate* estimates) {
  PackAll(readings, count);
  search_.Forget();
  std::size_t searched = 0;  // all frames before are, or have one contact
  for (std::size_t i = 0; i < count; ++i) {
    if (Slides(readings[i])) {
      search_.Forget();
      searched = i + 1;
      continue;
    }
    Explain(readings[i], packed_[i], &estimates[i]);
    if (search_.course() == ContactSearch::Course::kContinued) continue;
    if (search_.course() == ContactSearch::Course::kSurprised) {
      for (; searched <= i; ++searched) {
        search_.Forget();
        Explain(readings[searched], packed_[searched], &estimates[searched]);
      }
    }
    searched = i + 1;
  }
  if (setup_.scene.smoothing) {
    SmoothBlock(readings, count, {}, estimates);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!Slides(readings[i])) Judge(readings[i], packed_[i], &estimates[i]);
  }
  // These use the memory of the packed frames.
  for (std::size_t i = 0; i < count; ++i) {
    if (Slides(readings[i])) estimates[i] = EstimateSliding(readings[i]);
  }
}

const FrameEstimate& FrameEstimator::Next(const Measurements& readings) {
  if (live_.offsets) {
    NextAlone(live_.offsets->Correct(readings));
    live_.offsets->Judge(&live_.estimate);
  } else {
    NextAlone(readings);
  }
  return live_.estimate;
}

void FrameEstimator::NextAlone(const Measurements& readings) {
  if (Slides(readings)) {
    search_.Forget();
    live_.estimate = EstimateSliding(readings);
    return;
  }
  PackAll(&readings, 1);
  Explain(readings, packed_[0], &live_.estimate);
  if (setup_.scene.smoothing) {
    live_.smoothed = SmoothBlock(&readings, 1, live_.smoothed, &live_.estimate);
  } else {
    Judge(readings, packed_[0], &live_.estimate);
  }
}

LogPrior FrameEstimator::SmoothBlock(const Measurements* readings,
                                     std::size_t count, const LogPrior& before,
                                     FrameEstimate* estimates) {
  std::vector<char> sure(count);
  for (std::size_t i = 0; i < count; ++i) {
    sure[i] = IsSure(estimates[i], packed_[i]);
  }
  const LogPrior next =
      Smooth(setup_.finger, setup_.scene, setup_.discretization, readings,
             count, before, estimates, &sure);
  for (std::size_t i = 0; i < count; ++i) {
    Judge(readings[i], packed_[i], &estimates[i]);
    if (estimates[i].contacts == 1 && !sure[i]) {
      estimates[i].status = FrameStatus::kUnobservable;
    }
  }
  return next;
}

void FrameEstimator::PackAll(const Measurements* readings, std::size_t count) {
  if (packed_.size() < count) packed_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Pack(setup_.finger, setup_.scene, readings[i], &packed_[i]);
    packed_[i].free_chi2 = search_.FreeChi2(readings[i]);
  }
}

void FrameEstimator::Explain(const Measurements& readings,
                             const PackedReadings& packed,
                             FrameEstimate* estimate) {
  search_.Begin(readings);
  const int contacts = setup_.scene.contacts.value_or(1);
  if (packed.gauges + packed.camera < 1 || packed.all < kUnknowns * contacts) {
    Unsolved(FrameStatus::kBadInput, estimate);
  } else if (setup_.scene.contacts) {
    WithContacts(readings, packed, contacts, estimate);
  } else {
    Automatic(readings, packed, estimate);
  }
  if (!search_.ended()) return;
  if (estimate->contacts == 0) Unsolved(FrameStatus::kNotConverged, estimate);
  estimate->search_ended = true;
}

// Adds a contact as long as it makes a significant difference. The free finger
// predicts no place of a measured object, so that place only distinguishes one
// contact from another.
void FrameEstimator::Automatic(const Measurements& readings,
                               const PackedReadings& packed,
                               FrameEstimate* estimate) {
  if (packed.free_chi2 < kSignificance) return Free(packed, estimate);
  // A second contact must lower chi2 by so much.
  const double significance =
      search_.IsDoubted(packed) ? kDoubtedSignificance : kSecondSignificance;
  const bool one = search_.Search(1, packed);
  if (one) {
    if (packed.free_chi2 - search_.best().chi2 < kSignificance) {
      return Free(packed, estimate);
    }
    Found(readings, packed, estimate);
  } else {
    Unsolved(FrameStatus::kNotConverged, estimate);
  }
  // If no search with one contact converges, two contacts must do what the
  // first and the second have to do.
  const double without =
      one ? search_.best().chi2 : packed.free_chi2 - kSignificance;
  const auto gauges = static_cast<std::size_t>(packed.gauges);
  if (without < significance || setup_.scene.MostContacts(gauges) < 2) return;
  // Errors of the calibration bend the readings of one contact too. A second
  // one must explain more than they do.
  const double model_without = one ? ModelChi2(readings, packed) : without;
  if (model_without < significance) return;
  const int before = search_.iterations();
  if (!search_.Search(2, packed, LeastForce_N(setup_.finger))) return;
  const ContactSolution& two = search_.best();
  if (two.LesserForce_N() < LeastForce_N(setup_.finger)) return;
  if (without - two.chi2 < significance) return;
  // Written so that a difference of infinities is none.
  if (one && !(model_without - ModelChi2(readings, packed) >= significance)) {
    return;
  }
  Found(readings, packed, estimate);
  estimate->iterations += before;
}

// chi2 of the best solution with the errors that the calibration may have.
double FrameEstimator::ModelChi2(const Measurements& readings,
                                 const PackedReadings& packed) {
  const ContactSolution& best = search_.best();
  if (systematic_.empty() || packed.camera > 0) return best.chi2;
  contacts_.assign(best.contacts.begin(), best.contacts.begin() + best.count);
  return systematic_.Chi2(contacts_, readings);
}

void FrameEstimator::WithContacts(const Measurements& readings,
                                  const PackedReadings& packed, int contacts,
                                  FrameEstimate* estimate) {
  if (contacts == 0) return Free(packed, estimate);
  if (!search_.Search(contacts, packed, LeastForce_N(setup_.finger))) {
    return Unsolved(FrameStatus::kNotConverged, estimate);
  }
  const ContactSolution& best = search_.best();
  if (best.LesserForce_N() < LeastForce_N(setup_.finger)) {
    return WithContacts(readings, packed, contacts - 1, estimate);
  }
  Found(readings, packed, estimate);
}

// Copies into the memory of the estimate: most frames of a log are free.
void FrameEstimator::Free(const PackedReadings& packed,
                          FrameEstimate* estimate) const {
  *estimate = free_;
  estimate->chi2 = packed.free_chi2;
  estimate->dof = packed.gauges + packed.camera;
}

void FrameEstimator::Unsolved(FrameStatus status,
                              FrameEstimate* estimate) const {
  *estimate = free_;
  estimate->status = status;
  estimate->contact[0].normal_N = kNaN;
  estimate->tip_pose.setConstant(kNaN);
  std::fill(estimate->rib_tension_N.begin(), estimate->rib_tension_N.end(),
            kNaN);
}

void FrameEstimator::Found(const Measurements& readings,
                           const PackedReadings& packed, FrameEstimate* to) {
  const ContactSolution& best = search_.best();
  FrameEstimate& estimate = *to;
  Unsolved(FrameStatus::kNotConverged, to);
  estimate.contacts = best.count;
  CopyContacts(best, &estimate.contact);
  estimate.tip_pose = best.tip_pose;
  estimate.rib_tension_N = best.rib_tension_N;
  estimate.chi2 = best.chi2;
  estimate.dof = packed.all - kUnknowns * best.count;
  estimate.iterations = search_.iterations();

  const ContactMatrix covariance = CovarianceOf(best.information);
  estimate.noise_covariance = covariance;
  ExplainByModelErrors(readings, packed, to);
  const double scale = estimate.noise_scale();
  ContactsStd std{};
  for (int k = 0; k < kUnknowns * best.count; ++k) {
    std[k] = scale * std::sqrt(covariance(k, k));
  }
  if (best.count == 2) {
    std = ProfiledStd(search_.profile(), best, std, scale, kTwoContactsRule);
  } else if (packed.camera == 0) {  // its points are not in the table
    estimate.valley = FindValley(search_.profile(), best, std, scale,
                                 setup_.finger.front_length_mm);
    if (estimate.valley) {
      std[0] *= estimate.valley->arc_factor;
      std[1] *= estimate.valley->normal_factor;
    }
  }
  for (int c = 0; c < best.count; ++c) {
    estimate.contact[c].arc_std_mm = std[kUnknowns * c];
    estimate.contact[c].normal_std_N = std[kUnknowns * c + 1];
  }
  if (const ContactSolution* rival = search_.rival()) {
    CopyContacts(*rival, &estimate.alternative);
    estimate.alternative_chi2 = rival->chi2;
  }
}

void FrameEstimator::SetContacts(const FrameEstimate& estimate) {
  contacts_.clear();
  for (int c = 0; c < estimate.contacts; ++c) {
    contacts_.push_back({estimate.contact[c].arc_mm,
                         estimate.contact[c].normal_N, search_.friction()});
  }
}

}  // namespace finray

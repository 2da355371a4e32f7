#include "finray/estimation/frame_estimator.h"

#include <algorithm>
#include <cmath>

#include "finray/estimation/free_frame.h"
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

// The std of two contacts in a curved valley may be so many times those that
// are allowed elsewhere.
constexpr double kPairValley = 3;

// The std of an unknown of two contacts without their valley.
double LocalStd(const FrameEstimate& estimate, int k) {
  const double noise =
      estimate.noise_scale() * std::sqrt(estimate.noise_covariance(k, k));
  return estimate.calibration_covariance.size() == 0
             ? noise
             : std::hypot(noise,
                          std::sqrt(estimate.calibration_covariance(k, k)));
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
    : finger_((CheckScene(finger, scene), finger)),
      scene_(scene),
      discretization_(discretization),
      method_(method),
      least_force_N_(LeastForce_N(finger)),
      search_(finger, scene, discretization, method),
      systematic_(finger, scene, discretization),
      free_(FreeEstimate(finger, discretization)) {
  unsolved_.rib_tension_N.assign(free_.rib_tension_N.size(), kNaN);
  if (scene.gauge_offset_walk) {
    offsets_.emplace(finger, *scene.gauge_offset_walk,
                     search_.table().free_angles());
  }
  scene_.gauge_offset_walk.reset();
}

FrameEstimator::FrameEstimator(const FrameEstimator& other)
    : finger_(other.finger_),
      scene_(other.scene_),
      discretization_(other.discretization_),
      method_(other.method_),
      least_force_N_(other.least_force_N_),
      search_(finger_, scene_, discretization_, method_,
              other.search_.tables()),
      systematic_(other.systematic_),
      offsets_(other.offsets_),
      free_(other.free_),
      unsolved_(other.unsolved_) {
  if (offsets_) offsets_->Restart();
}

std::unique_ptr<FrameEstimator> FrameEstimator::ForAnotherThread() const {
  return std::unique_ptr<FrameEstimator>(new FrameEstimator(*this));
}

std::unique_ptr<FrameEstimator> FrameEstimator::WithErrorsOf(
    const ParameterCovariance& calibration) const {
  auto other = ForAnotherThread();
  other->finger_.calibration = calibration;
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
  const double friction = scene_.friction_coefficient;
  return std::abs(readings.FrictionOr(friction) - friction) >
         kSame * std::abs(friction);
}

// Friction that pulls the other way has tables of its own.
FrameEstimate FrameEstimator::EstimateSliding(const Measurements& readings) {
  const double friction = scene_.friction_coefficient;
  FrameEstimator* way = this;
  if (readings.friction * friction < 0) {
    if (!reversed_) {
      Scene scene = scene_;
      scene.friction_coefficient = -friction;
      reversed_ = std::make_unique<FrameEstimator>(
          WithFrictionReversed(finger_), scene, discretization_, method_);
    }
    way = reversed_.get();
  }
  way->search_.set_friction(readings.friction);
  FrameEstimate estimate = way->EstimateAlone(readings);
  estimate.friction = readings.friction;
  way->search_.set_friction(way->scene_.friction_coefficient);
  return estimate;
}

FrameEstimate FrameEstimator::EstimateAlone(const Measurements& readings) {
  FrameEstimate estimate;
  PackAll(&readings, 1);
  LeaveLastFrame();
  SearchAlone(readings, packed_[0], &estimate);
  Judge(readings, packed_[0], &estimate);
  return estimate;
}

void FrameEstimator::PackAll(const Measurements* readings, std::size_t count) {
  if (packed_.size() < count) packed_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Pack(finger_, scene_, readings[i], &packed_[i]);
    packed_[i].free_chi2 = search_.FreeChi2(readings[i]);
  }
}

void FrameEstimator::SearchAlone(const Measurements& readings,
                                 const PackedReadings& packed,
                                 FrameEstimate* estimate) {
  search_.Begin(readings);
  Explain(readings, packed, estimate);
}

void FrameEstimator::Explain(const Measurements& readings,
                             const PackedReadings& packed,
                             FrameEstimate* estimate) {
  const int contacts = scene_.contacts.value_or(1);
  if (packed.gauges + packed.camera < 1 || packed.all < kUnknowns * contacts) {
    Unsolved(FrameStatus::kBadInput, estimate);
  } else if (scene_.contacts) {
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
  Unsolved(FrameStatus::kNotConverged, estimate);
  // A second contact must lower chi2 by so much.
  const double significance =
      search_.IsDoubted(packed) ? kDoubtedSignificance : kSecondSignificance;
  const bool one = search_.Search(1, packed);
  if (one) {
    if (packed.free_chi2 - search_.best().chi2 < kSignificance) {
      return Free(packed, estimate);
    }
    Found(readings, packed, estimate);
  }
  // If no search with one contact converges, two contacts must do what the
  // first and the second have to do.
  const double without =
      one ? search_.best().chi2 : packed.free_chi2 - kSignificance;
  const auto gauges = static_cast<std::size_t>(packed.gauges);
  if (without < significance || scene_.MostContacts(gauges) < 2) return;
  // Errors of the calibration bend the readings of one contact too. A second
  // one must explain more than they do.
  const double model_without = one ? ModelChi2(readings, packed) : without;
  if (model_without < significance) return;
  const int before = search_.iterations();
  if (!Fit(2, packed)) return;
  const ContactSolution& two = search_.best();
  for (const PointContact& contact : two.contacts) {
    if (contact.normal_N < least_force_N_) return;
  }
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
  if (!Fit(contacts, packed)) {
    return Unsolved(FrameStatus::kNotConverged, estimate);
  }
  const ContactSolution& best = search_.best();
  for (int c = 0; c < best.count; ++c) {
    if (best.contacts[c].normal_N < least_force_N_) {
      return WithContacts(readings, packed, contacts - 1, estimate);
    }
  }
  Found(readings, packed, estimate);
}

bool FrameEstimator::Fit(int contacts, const PackedReadings& packed) {
  return following_two_ && contacts == 2
             ? search_.Follow(packed)
             : search_.Search(contacts, packed, least_force_N_);
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
  *estimate = unsolved_;
  estimate->status = status;
}

void FrameEstimator::Found(const Measurements& readings,
                           const PackedReadings& packed, FrameEstimate* to) {
  const ContactSolution& best = search_.best();
  FrameEstimate& estimate = *to;
  estimate = unsolved_;
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
                                 finger_.front_length_mm);
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

// Rare only for a finger that is well known: it solves an equilibrium.
void FrameEstimator::ExplainByModelErrors(const Measurements& readings,
                                          const PackedReadings& packed,
                                          FrameEstimate* estimate) {
  if (systematic_.empty() || packed.all > packed.gauges ||
      !(estimate->p_value() < FrameEstimate::kUnexplained)) {
    return;
  }
  SetContacts(*estimate);
  estimate->model_chi2 = systematic_.Chi2(contacts_, readings);
}

void FrameEstimator::Judge(const Measurements& readings,
                           const PackedReadings& packed,
                           FrameEstimate* estimate) {
  if (estimate->contacts == 0) {
    if (estimate->status == FrameStatus::kNoContact) {
      JudgeFree(readings, &systematic_, estimate);
    }
    return;
  }
  estimate->SetNoise();
  if (!systematic_.empty()) {
    SetContacts(*estimate);
    estimate->calibration_covariance = systematic_.Of(contacts_, readings);
    if (estimate->contacts == 1 &&
        std::isfinite(estimate->calibration_covariance(0, 0))) {
      estimate->force_std_N = std::hypot(
          std::hypot(1, search_.friction()) * estimate->contact[0].normal_std_N,
          std::sqrt(systematic_.whole_force_variance_N2()));
    }
    AddCovariance(estimate->calibration_covariance, estimate);
  }
  estimate->SetIntervals(finger_.front_length_mm);
  estimate->status = StatusOf(*estimate, finger_, search_);
  // Two contacts explain any reading of as many gauges as unknowns, so that
  // nothing there says whether there are two.
  if (!search_.IsDoubted(packed)) return;
  const double chi2 = estimate->explained_chi2();
  if (estimate->contacts == 2 || chi2 >= kDoubtedSignificance) {
    estimate->status = FrameStatus::kUnobservable;
  }
  estimate->may_be_two = estimate->contacts == 1 && chi2 >= kSecondSignificance;
}

void FrameEstimator::AddCovariance(const ContactMatrix& covariance,
                                   FrameEstimate* estimate) {
  for (int c = 0; c < estimate->contacts; ++c) {
    ContactEstimate& contact = estimate->contact[c];
    contact.arc_std_mm =
        std::hypot(contact.arc_std_mm, std::sqrt(covariance(2 * c, 2 * c)));
    contact.normal_std_N = std::hypot(
        contact.normal_std_N, std::sqrt(covariance(2 * c + 1, 2 * c + 1)));
  }
}

FrameStatus FrameEstimator::StatusOf(const FrameEstimate& estimate,
                                     const Finger& finger,
                                     const ContactSearch& search) {
  bool determined =
      std::isnan(estimate.alternative_chi2) && !estimate.search_ended;
  const bool pair = estimate.contacts == 2;
  for (int c = 0; c < estimate.contacts; ++c) {
    const ContactEstimate& contact = estimate.contact[c];
    const auto is_sure = [&](double arc_std_mm, double normal_std_N) {
      return arc_std_mm <= kLargestArcStd * finger.front_length_mm &&
             normal_std_N <= kLargestForceStd * contact.normal_N;
    };
    determined &= !search.OnBound(contact.arc_mm, contact.normal_N);
    if (!pair) {
      determined &= is_sure(contact.arc_std_mm, contact.normal_std_N);
      continue;
    }
    // Those of the minimum, and those of its valley.
    determined &=
        is_sure(LocalStd(estimate, 2 * c), LocalStd(estimate, 2 * c + 1)) &&
        is_sure(contact.arc_std_mm / kPairValley,
                contact.normal_std_N / kPairValley);
  }
  return determined ? FrameStatus::kOk : FrameStatus::kUnobservable;
}

}  // namespace finray

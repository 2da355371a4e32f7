// The part of FrameEstimator that decides the status of a solved frame.

#include <algorithm>
#include <cmath>

#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/free_frame.h"

namespace finray {
namespace {

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

}  // namespace

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
  estimate->SetIntervals(setup_.finger.front_length_mm);
  estimate->may_be_two = estimate->contacts == 1 && search_.IsDoubted(packed) &&
                         estimate->explained_chi2() >= kSecondSignificance;
  estimate->status =
      IsSure(*estimate, packed) ? FrameStatus::kOk : FrameStatus::kUnobservable;
}

// Two contacts explain any reading of as many gauges as unknowns, so that
// nothing there says whether there are two.
bool FrameEstimator::IsSure(const FrameEstimate& estimate,
                            const PackedReadings& packed) const {
  const bool untold = search_.IsDoubted(packed) &&
                      (estimate.contacts == 2 ||
                       estimate.explained_chi2() >= kUntoldSignificance);
  return !untold &&
         StatusOf(estimate, setup_.finger, search_) == FrameStatus::kOk;
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
    // The limits hold for the std of the minimum and, kPairValley times as
    // wide, for the std of its valley.
    determined &=
        is_sure(LocalStd(estimate, 2 * c), LocalStd(estimate, 2 * c + 1)) &&
        is_sure(contact.arc_std_mm / kPairValley,
                contact.normal_std_N / kPairValley);
  }
  return determined ? FrameStatus::kOk : FrameStatus::kUnobservable;
}

}  // namespace finray

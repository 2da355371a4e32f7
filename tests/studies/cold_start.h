#ifndef FINRAY_TESTS_STUDIES_COLD_START_H_
#define FINRAY_TESTS_STUDIES_COLD_START_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "studies/gauge_frames.h"

namespace finray {

/// How frames without noise came out of a cold start.
struct ColdStartTally {
  int frames = 0;
  int right = 0;         ///< l_c and f_c as they were
  int unobservable = 0;  ///< not right, but said to be not determined
  int no_contact = 0;    ///< said to be free, which chi2 does not contradict
  int ambiguous = 0;     ///< another contact whose readings are less than 1 std
                         ///< away
  int wrong = 0;         ///< none of these
  int sure_and_wrong = 0;  ///< of any status: 4 std off, std small

  void Add(const ColdStartTally& other) {
    frames += other.frames;
    right += other.right;
    unobservable += other.unobservable;
    no_contact += other.no_contact;
    ambiguous += other.ambiguous;
    wrong += other.wrong;
    sure_and_wrong += other.sure_and_wrong;
  }
};

/// Estimates contacts from their clean readings, each on its own.
class ColdStart {
 public:
  ColdStart(const Finger& finger, const Scene& scene)
      : estimator_(finger, scene, {}), solver_(finger, {}) {}

  ColdStartTally Run(double arc_mm, double force_N) {
    ColdStartTally tally;
    if (!solver_.Solve({{arc_mm, force_N, 0}})) return tally;
    const Finger& finger = estimator_.finger();
    const Measurements readings = CleanReadings(solver_);
    const FrameEstimate estimate = estimator_.Estimate(readings);
    const ContactEstimate& found = estimate.contact[0];
    const double arc_error = std::abs(found.arc_mm - arc_mm);
    const double force_error = std::abs(found.normal_N - force_N);
    tally.frames = 1;
    // A thousandth of a std where gauges hardly tell the place.
    tally.right = arc_error < std::max(1e-4, 1e-3 * found.arc_std_mm) &&
                  force_error < std::max(1e-6, 1e-3 * found.normal_std_N);
    if (!tally.right) {
      tally.no_contact = estimate.status == FrameStatus::kNoContact &&
                         estimate.chi2 < FrameEstimator::kSignificance;
      tally.unobservable = estimate.status == FrameStatus::kUnobservable;
      tally.ambiguous =
          estimate.status == FrameStatus::kOk && estimate.chi2 < 1;
      tally.wrong =
          !tally.no_contact && !tally.unobservable && !tally.ambiguous;
    }
    tally.sure_and_wrong = !tally.ambiguous && arc_error > 1e-4 &&
                           arc_error > 4 * found.arc_std_mm &&
                           found.arc_std_mm < FrameEstimator::kLargestArcStd *
                                                  finger.front_length_mm;
    return tally;
  }

 private:
  FrameEstimator estimator_;
  EquilibriumSolver solver_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_COLD_START_H_

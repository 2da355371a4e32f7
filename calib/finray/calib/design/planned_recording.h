#ifndef FINRAY_CALIB_DESIGN_PLANNED_RECORDING_H_
#define FINRAY_CALIB_DESIGN_PLANNED_RECORDING_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// A contact that a recording should have; without force a free frame.
struct PlannedContact {
  double contact_mm = 0, normal_N = 0;

  bool touches() const { return normal_N > 0; }
};

/// Heights and loads between which contacts are spread.
struct ContactRange {
  double from_mm, to_mm;
  double least_N, most_N;
};

/// Returns `count` frames, every kFreeEvery-th of them free and the others
/// spread evenly by sequences of low discrepancy: heights by the golden ratio,
/// loads by van der Corput's. So the first n frames are spread evenly for each
/// n. `seed` shifts both.
std::vector<PlannedContact> SpreadContacts(const ContactRange& range,
                                           std::size_t count,
                                           std::uint64_t seed);
constexpr std::size_t kFreeEvery = 10;

/// A recording that nobody has made, of a finger that is exactly as given, with
/// gauges, reference force and, of a circle, the object's place; without a
/// circle the place of the contact is measured instead. It says what a
/// calibration by the plan would know of the finger.
class PlannedRecording {
 public:
  /// Contacts that the finger cannot carry are left out. Throws InputError if
  /// the plan frees nothing that these frames could tell.
  PlannedRecording(const Finger& finger, const Plan& plan,
                   const std::vector<PlannedContact>& contacts,
                   const Discretization& discretization);

  CalibrationProblem& problem() { return *problem_; }
  const CalibrationProblem& problem() const { return *problem_; }
  /// The frames as the plan fits them. CalibrationFrame::row is the index of
  /// the planned contact. The derivatives are by the free parameters in
  /// CalibrationParameters::Units().
  struct Row {
    std::size_t contact;  ///< Index of the planned contact.
    LinearizedFrame at;
  };
  const std::vector<Row>& rows() const { return rows_; }
  /// The finger with the covariance that the calibration leaves.
  Finger Calibrated() const;

 private:
  std::unique_ptr<CalibrationProblem> problem_;
  std::vector<Row> rows_;
  Identifiability found_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_PLANNED_RECORDING_H_

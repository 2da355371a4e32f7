#include "finray/calib/design/planned_recording.h"

#include <cmath>

#include "finray/calib/analysis/predicted_frames.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/frame_pass.h"
#include "finray/io/nan.h"

namespace finray {
namespace {

constexpr double kSecondsPerFrame = 10;

double Fraction(double value) { return value - std::floor(value); }

// The bits of n behind the point, in reverse: van der Corput's sequence.
double Reversed(std::size_t n) {
  double sum = 0, bit = 0.5;
  for (; n > 0; n /= 2, bit /= 2) sum += bit * static_cast<double>(n % 2);
  return sum;
}

}  // namespace

std::vector<PlannedContact> SpreadContacts(const ContactRange& range,
                                           std::size_t count,
                                           std::uint64_t seed) {
  constexpr double kGolden = 0.61803398874989484820;
  const double shift = Fraction(static_cast<double>(seed) * std::sqrt(2.0));
  std::vector<PlannedContact> frames(count);
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kFreeEvery == 0) continue;
    ++contacts;
    frames[i].contact_mm =
        range.from_mm +
        (range.to_mm - range.from_mm) *
            Fraction(shift + static_cast<double>(contacts) * kGolden);
    frames[i].normal_N =
        range.least_N +
        (range.most_N - range.least_N) * Fraction(shift + Reversed(contacts));
  }
  return frames;
}

PlannedRecording::PlannedRecording(const Finger& finger, const Plan& plan,
                                   const std::vector<PlannedContact>& contacts,
                                   const Discretization& discretization) {
  CalibrationLogs logs;
  logs.paths = logs.names = {"the planned recording"};
  Contacts at;
  EquilibriumSolver solver(finger, discretization);
  const std::vector<bool> all(finger.gauges.size(), true);
  const double friction = plan.scene.friction_coefficient;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const PlannedContact& planned = contacts[i];
    CalibrationFrame frame;
    frame.row = static_cast<int>(i);
    frame.time_s = kSecondsPerFrame * static_cast<double>(i);
    frame.temperature_C = plan.reference_temperature_C;
    frame.contact = planned.touches();
    std::vector<PointContact> points;
    if (planned.touches()) {
      points.push_back({planned.contact_mm, planned.normal_N, friction});
    }
    if (!PredictReadings(points, all, plan, {}, &solver, &frame)) continue;
    // A stage tells the place of a circle; who has none measures the contact.
    if (plan.scene.circle_radius_mm()) frame.contact_mm = kNaN;
    logs.frames.push_back(frame);
    at.push_back({planned.contact_mm, planned.normal_N});
  }
  problem_ = std::make_unique<CalibrationProblem>(finger, plan, logs,
                                                  discretization, 1);
  // A solve starts from the readings of free rows. Here offsets are known, and
  // ribs may prestress the finger.
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    *problem_->parameters().readings.offset_V(static_cast<int>(j), 0) =
        finger.gauges[j].offset_V;
  }
  ContactStore places(problem_.get());
  places.Set(at);
  const std::vector<int>& frames = problem_->candidates();
  const auto columns =
      static_cast<Eigen::Index>(problem_->parameters().free().size());
  const Eigen::VectorXd unit = problem_->parameters().Units();
  Linearization sum(static_cast<int>(columns), frames.size());
  LinearizeFrames(
      frames, problem_.get(), &places,
      [&](int frame, const LinearizedFrame& at) {
        sum.Add(frame, 0, at);
        Row row{static_cast<std::size_t>(problem_->frame(frame).row), at};
        row.at.by_parameter *= unit.asDiagonal();
        row.at.reduced *= unit.asDiagonal();
        rows_.push_back(std::move(row));
      });
  sum.Finish();
  found_ = AnalyzeIdentifiability(problem_.get(), sum);
}

Finger PlannedRecording::Calibrated() const {
  Finger finger = problem_->finger();
  KeepCovariance(problem_->parameters(), found_, &finger);
  return finger;
}

}  // namespace finray

#ifndef FINRAY_TESTS_STUDIES_PAPER_PROTOCOL_H_
#define FINRAY_TESTS_STUDIES_PAPER_PROTOCOL_H_

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "finray/calib/report/calibration_result.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/scene/simulation.h"
#include "studies/gauge_frames.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {

/// The circle against the finger at one height of its centre.
struct ProtocolFrame {
  double height_mm;
  ObjectPose object;  ///< as it is; the stage reads it with an error
  Measurements clean;
  PointContact contact;
  Eigen::Vector3d pose;  ///< x, y, theta of the contact
};

/// A lab in which everything is known: the finger (the bundled dataset's hidden
/// one), a circle of R = 15 mm on a stage, gauges with noise of 3e-4 rad.
class SimulatedLab {
 public:
  static constexpr double kNoise_rad = 3e-4;
  static constexpr double kRadius_mm = 15;

  SimulatedLab()
      : finger_(
            WithNoiseOf(ReadFinger(FINRAY_SOURCE_DIR "/datasets/simulated_r15/"
                                                     "hidden_finger.yaml"))),
        nominal_(PaperFinger()),
        plan_(
            ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml")),
        calibration_log_(FrameTable::Read(FINRAY_SOURCE_DIR
                                          "/datasets/simulated_r15/"
                                          "train.csv")) {
    for (std::size_t j = 0; j < nominal_.gauges.size(); ++j) {
      nominal_.gauges[j].noise_V = finger_.gauges[j].noise_V;
    }
    Simulate(finger_, plan_.scene, {}, &calibration_log_);
  }

  const Finger& finger() const { return finger_; }

  const RigidObject& object() const { return *plan_.scene.object; }
  double stage_std_mm() const { return plan_.object_std_mm; }
  double force_std_N() const { return plan_.force_std_N; }

  /// The finger as its drawing says, with gauges calibrated on a bench and
  /// zeroed on the free finger: what one has who calibrates no finger.
  Finger Nominal() const {
    Finger finger = nominal_;
    EquilibriumSolver truth(finger_, {}), drawn(nominal_, {});
    truth.Solve({});
    drawn.Solve({});
    finger.gauges = finger_.gauges;
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      Gauge& gauge = finger.gauges[j];
      gauge.offset_V = gauge.Volts(truth.outputs()[j] - drawn.outputs()[j]);
    }
    return finger;
  }

  /// The finger as calibrated from a log of 200 contacts and 10 free frames at
  /// the places of the bundled one, with noise of `seed`, from the paper's
  /// nominal finger.
  Finger Calibrated(unsigned seed, int threads) const {
    const TempFolder folder;
    const std::string path = folder.Path("log.csv");
    MakeLog(finger_, calibration_log_,
            {plan_.force_std_N, plan_.object_std_mm, seed})
        .Write(path);
    CalibrationProblem problem(nominal_, plan_,
                               ReadCalibrationLogs({path}, nominal_, plan_), {},
                               threads);
    return Calibrate(&problem).finger;
  }

  /// The circle pressed in at each height until it takes each force. Left out
  /// where it then touches at two places.
  std::vector<ProtocolFrame> Press(const std::vector<double>& heights_mm,
                                   const std::vector<double>& forces_N) const {
    EquilibriumSolver solver(finger_, {});
    std::vector<ProtocolFrame> frames;
    for (const double height : heights_mm) {
      for (const double force : forces_N) {
        double low = 0, high = 20;
        ObjectContact found;
        for (int i = 0; i < 60 && high - low > 1e-9; ++i) {
          const double depth = (low + high) / 2;
          found = SolveObjectContact(
              *plan_.scene.object, ObjectPose{{depth - kRadius_mm, height}, 0},
              0, &solver, found.contacts);
          double sum = 0;
          for (const PointContact& c : found.contacts) sum += c.normal_N;
          (sum < force && found.status != ObjectContactStatus::kNotConverged
               ? low
               : high) = depth;
        }
        if (found.contacts.size() != 1) continue;
        frames.push_back({height,
                          {{low - kRadius_mm, height}, 0},
                          CleanReadings(solver),
                          found.contacts[0],
                          solver.contact_pose(0)});
      }
    }
    return frames;
  }

 private:
  static Finger WithNoiseOf(Finger finger) {
    for (Gauge& gauge : finger.gauges) {
      gauge.noise_V = kNoise_rad * std::abs(gauge.gain_V_per_rad);
    }
    return finger;
  }

  Finger finger_, nominal_;
  Plan plan_;
  FrameTable calibration_log_;
};

/// Error of one estimate, as the paper counts it; of no contact and of frames
/// without a solution everything is NaN.
struct ProtocolError {
  double place_mm, angle_deg, force_N;  ///< of the contact frame; all >= 0
  double arc_mm;                        ///< of l_c
  bool ok;                              ///< status
  Eigen::Vector3d pose;                 ///< the estimate itself
};

inline ProtocolError ErrorOf(const ProtocolFrame& frame,
                             const Eigen::Vector3d& pose, double arc_mm,
                             double normal_N, bool ok) {
  const Eigen::Vector3d off = pose - frame.pose;
  return {off.head<2>().norm(),
          std::abs(off[2]) * 180 / M_PI,
          std::abs(normal_N - frame.contact.normal_N),
          std::abs(arc_mm - frame.contact.arc_mm),
          ok,
          pose};
}

/// `noise_of`: the finger whose gauges' noise is added; null for none.
inline std::vector<ProtocolError> ProtocolErrors(
    const std::vector<ProtocolFrame>& frames, const Finger* noise_of,
    FrameEstimator* estimator, std::mt19937_64* generator) {
  std::vector<ProtocolError> errors;
  for (const ProtocolFrame& frame : frames) {
    const FrameEstimate estimate = estimator->Estimate(
        noise_of ? WithNoise(frame.clean, *noise_of, generator) : frame.clean);
    const ContactEstimate& found = estimate.contact[0];
    errors.push_back(ErrorOf(frame, found.pose, found.arc_mm, found.normal_N,
                             estimate.status == FrameStatus::kOk));
  }
  return errors;
}

/// The paper's kinetostatics: the contact that the finger of `solver` has where
/// the stage, with an error of `stage_std_mm` in x and y, says the object is.
/// No gauge is read. Where it has none everything is NaN.
inline std::vector<ProtocolError> KinetostaticErrors(
    const std::vector<ProtocolFrame>& frames, const RigidObject& object,
    double stage_std_mm, EquilibriumSolver* solver,
    std::mt19937_64* generator) {
  std::normal_distribution<double> unit;
  std::vector<ProtocolError> errors;
  for (const ProtocolFrame& frame : frames) {
    ObjectPose pose = frame.object;
    pose.position_mm.x() += stage_std_mm * unit(*generator);
    pose.position_mm.y() += stage_std_mm * unit(*generator);
    const ObjectContact found = SolveObjectContact(object, pose, 0, solver);
    const auto heaviest =
        std::max_element(found.contacts.begin(), found.contacts.end(),
                         [](const PointContact& a, const PointContact& b) {
                           return a.normal_N < b.normal_N;
                         });
    if (heaviest == found.contacts.end()) {
      const double none = std::nan("");
      errors.push_back(
          ErrorOf(frame, Eigen::Vector3d::Constant(none), none, none, false));
      continue;
    }
    const int index = static_cast<int>(heaviest - found.contacts.begin());
    errors.push_back(ErrorOf(frame, solver->contact_pose(index),
                             heaviest->arc_mm, heaviest->normal_N, true));
  }
  return errors;
}

inline double MeanOf(const std::vector<ProtocolError>& errors,
                     double ProtocolError::*which) {
  double sum = 0;
  for (const ProtocolError& error : errors) sum += error.*which;
  return sum / static_cast<double>(errors.size());
}

inline double RootMeanSquareOf(const std::vector<ProtocolError>& errors,
                               double ProtocolError::*which) {
  double sum = 0;
  for (const ProtocolError& error : errors) sum += std::pow(error.*which, 2);
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_PAPER_PROTOCOL_H_

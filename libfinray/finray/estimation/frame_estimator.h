#ifndef FINRAY_ESTIMATION_FRAME_ESTIMATOR_H_
#define FINRAY_ESTIMATION_FRAME_ESTIMATOR_H_

#include "finray/estimation/contact_search.h"
#include "finray/estimation/frame_estimate.h"
#include "finray/estimation/live_offsets.h"
#include "finray/estimation/log_prior.h"
#include "finray/finger/finger.h"
#include "finray/fit/calibration_errors.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

/// Estimates the contacts of frames without a guess, and decides each frame's
/// status. ContactSearch finds l_c and f_c. The scene gives the number of
/// contacts; `contacts: auto` takes the fewest that explain the readings. An
/// estimator takes some milliseconds to make. Use it from one thread at a time.
///
/// `contacts: auto` takes a contact if it lowers chi2 by kSignificance or more.
/// With four gauges or more it takes a second one if that lowers chi2 by
/// another kSecondSignificance or more, with as many readings as unknowns
/// kDoubtedSignificance, also with the errors that the finger's calibration may
/// have (CalibrationErrors::Chi2). Frames whose chi2 with one contact is less
/// are not searched for two.
///
/// The scene's gauge_offset_walk counts in Next() only (LiveOffsets).
///
/// If the model with the declared noise does not explain a frame, its std are
/// those of a noise that would (FrameEstimate::noise_scale).
///
/// A frame's status is decided in this class (docs/reference/estimation.md):
/// - bad_input (Explain): fewer measurements than unknowns, or impossible ones.
/// - no_contact: none is significant (Automatic), or all of a fixed number are
///   below kLeastForce_N, for soft fingers kLeastForce (WithContacts); and the
///   free finger explains the frame, else it is unobservable (free_frame.h).
/// - not_converged (Automatic, WithContacts): no start of the search led to a
///   solution.
/// - unobservable (Judge): solved, but the std of l_c is above kLargestArcStd
///   of l_0, the std of f_c is above kLargestForceStd of f_c (of two contacts
///   in a valley three times that), a bound is met, another solution is as
///   good, nobody can tell whether there is a second contact
///   (kUntoldSignificance), or Scene::search_iteration_limit ended the search
///   (search_ended). A frame without any solution by then is not_converged. A
///   smoothed frame is unobservable too where neither it nor a frame of its
///   part is sure alone (smoothing.h).
/// - ok (Judge): everything else.
class FrameEstimator {
 public:
  static constexpr int kUnknowns = 2;            ///< Of a contact.
  static constexpr double kSignificance = 13.8;  // chi2, 2 dof, p = 0.001
  /// A second contact can explain almost any reading, so it needs p = 1e-7.
  static constexpr double kSecondSignificance = 32.2;
  /// Two contacts explain any reading of as many gauges as unknowns, a small
  /// error of the finger too: nobody can tell whether there is a second one
  /// where one contact leaves this chi2 or more. An error of 3.3 std in each of
  /// four gauges, with their noise, leaves as much in one frame of twenty at
  /// most.
  static constexpr double kUntoldSignificance = 70;
  /// A second contact is looked for there from this on, which such an error
  /// leaves in no frame of a thousand: the search takes a hundred times as long
  /// as a fit of one contact.
  static constexpr double kDoubtedSignificance = 100;
  static constexpr double kLeastForce_N = 0.03;
  static constexpr double kLeastForce = 0.05;  ///< In units of EI / l_0^2.
  static constexpr double kLargestArcStd = 0.05;
  static constexpr double kLargestForceStd = 0.25;

  /// Throws InputError for a scene with more than two contacts or with contacts
  /// on the back beam, for a finger without gauges or with fewer than the
  /// contacts need, and for a finger without an unloaded equilibrium.
  FrameEstimator(const Finger& finger, const Scene& scene,
                 const Discretization& discretization = {},
                 FrameMethod method = FrameMethod::kFast);
  FrameEstimator& operator=(const FrameEstimator&) = delete;

  /// Makes another estimator of the same finger and scene, for another thread.
  /// It starts a new log. Both share the tables of the search, so that it takes
  /// far less time. No thread may use this one meanwhile.
  std::unique_ptr<FrameEstimator> ForAnotherThread() const;
  /// The same under another calibration of the same parameters. Only its
  /// covariance and its discrepancy count, not its values.
  std::unique_ptr<FrameEstimator> WithErrorsOf(
      const ParameterCovariance& calibration) const;

  /// Estimates one frame by itself.
  FrameEstimate Estimate(const Measurements& readings);

  /// Estimates consecutive frames, smoothed if the scene says so. The result
  /// depends only on these readings.
  void EstimateBlock(const Measurements* readings, std::size_t count,
                     FrameEstimate* estimates);

  // Frames that arrive one by one, for control loops and displays
  // (docs/guides/sense_live.md):

  /// Estimates the next frame of a log. If the scene asks for smoothing, the
  /// frames before smooth it. Another explanation of two contacts that are
  /// continued may be noticed up to twelve frames late, while EstimateBlock
  /// then searches the frames before, too. The result is good until the next
  /// call.
  const FrameEstimate& Next(const Measurements& readings);
  /// Makes what frames with the scene's friction would make when they first
  /// need it, so that none of them waits.
  void Prepare() {
    search_.Prepare();
    systematic_.Prepare();
  }
  /// The next call of Next() starts a new log.
  void Restart() {
    search_.Forget();
    live_.smoothed = {};
    if (live_.offsets) live_.offsets->Restart();
  }

  const Finger& finger() const { return setup_.finger; }
  /// No force of a contact is larger (Scene::force_max_N).
  double most_force_N() const { return search_.most_force_N(); }

  // LogEstimator judges its frames by these, too.

  /// The lesser of kLeastForce_N and kLeastForce, in N.
  static double LeastForce_N(const Finger& finger);
  /// The estimate of a frame without a contact, but for chi2 and dof.
  static FrameEstimate FreeEstimate(const Finger& finger,
                                    const Discretization& discretization);
  /// Adds a covariance of (l_c, f_c) of each contact to the std.
  static void AddCovariance(const ContactMatrix& covariance,
                            FrameEstimate* estimate);
  /// Returns ok if the readings determine all contacts of the estimate, else
  /// unobservable.
  static FrameStatus StatusOf(const FrameEstimate& estimate,
                              const Finger& finger,
                              const ContactSearch& search);

 private:
  FrameEstimator(const FrameEstimator& other);
  bool Slides(const Measurements& readings) const;
  FrameEstimate EstimateSliding(const Measurements& readings);
  FrameEstimate EstimateAlone(const Measurements& readings);
  void NextAlone(const Measurements& readings);
  // Packs the readings and finds their chi2 without a contact.
  void PackAll(const Measurements* readings, std::size_t count);
  // Explains the frame after the last one.
  void Explain(const Measurements& readings, const PackedReadings& packed,
               FrameEstimate* estimate);
  // Smooths and judges frames of one log.
  LogPrior SmoothBlock(const Measurements* readings, std::size_t count,
                       const LogPrior& before, FrameEstimate* estimates);
  void Automatic(const Measurements& readings, const PackedReadings& packed,
                 FrameEstimate* estimate);
  double ModelChi2(const Measurements& readings, const PackedReadings& packed);
  void WithContacts(const Measurements& readings, const PackedReadings& packed,
                    int contacts, FrameEstimate* estimate);
  void Free(const PackedReadings& packed, FrameEstimate* estimate) const;
  void Unsolved(FrameStatus status, FrameEstimate* estimate) const;
  // The best solution of the search as an estimate.
  void Found(const Measurements& readings, const PackedReadings& packed,
             FrameEstimate* to);
  // Sets contacts_ to those of an estimate.
  void SetContacts(const FrameEstimate& estimate);
  void ExplainByModelErrors(const Measurements& readings,
                            const PackedReadings& packed,
                            FrameEstimate* estimate);
  // Adds the uncertainty of the calibration to the std of an estimate with
  // contacts, and sets its status to ok or unobservable.
  void Judge(const Measurements& readings, const PackedReadings& packed,
             FrameEstimate* estimate);
  // Says whether a solved frame may be ok with its present std.
  bool IsSure(const FrameEstimate& estimate,
              const PackedReadings& packed) const;

  // The arguments of the constructor.
  struct Setup {
    Finger finger;
    Scene scene;  // without gauge_offset_walk
    Discretization discretization;
    FrameMethod method;
  };
  // The state of Next() between two calls.
  struct Live {
    std::optional<LiveOffsets> offsets;  // where they wander
    LogPrior smoothed;                   // if the scene has smoothing
    FrameEstimate estimate;
  };

  Setup setup_;
  ContactSearch search_;
  CalibrationErrors systematic_;
  std::vector<PointContact> contacts_;
  FrameEstimate free_;
  Live live_;
  std::unique_ptr<FrameEstimator> reversed_;  // made when needed
  std::vector<PackedReadings> packed_;        // of the frames under way
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_FRAME_ESTIMATOR_H_

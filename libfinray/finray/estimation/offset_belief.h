#ifndef FINRAY_ESTIMATION_OFFSET_BELIEF_H_
#define FINRAY_ESTIMATION_OFFSET_BELIEF_H_

#include <Eigen/Core>

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Gauge offsets as Gaussians that do not depend on each other.
struct OffsetBelief {
  double time_s = 0;
  Eigen::VectorXd mean_V, variance_V2;

  /// Blurs the belief by a random walk from time_s to another time, later or
  /// earlier.
  void Wander(double to_s, double walk_V2_per_s);

  /// Takes the readings of a row of the free finger into account: its gauges
  /// have `angles`, so that the rest is offset and noise.
  void Absorb(const Finger& finger, const Eigen::VectorXd& angles,
              const Measurements& row);
};

/// Copies a row with its readings moved from offsets that are believed to those
/// of the finger, and with what is not known of them in history_std_V.
void MoveToOffsetsOf(const Finger& finger, const OffsetBelief& belief,
                     const Measurements& row, Measurements* moved);

/// What the gauges read beside the free finger, whose gauges have `angles`, in
/// V: their offsets and what touches. NaN for a gauge that is not measured.
void ReadBesideFree(const Finger& finger, const Eigen::VectorXd& angles,
                    const Measurements& row, Eigen::VectorXd* beside_V);

/// Tells the end of a touch from offsets that wander under it.
///
/// The longer a touch lasts, the less is known of the offsets, until the free
/// finger with other offsets explains its readings too. Such a frame is no free
/// one, because nothing has happened since the contact was sure. It is free
/// once the readings have surely left where the touch held them:
///
///   d'W D < kReleased D'W D - kSure sqrt(D'W D),
///
/// d what the gauges read beside the free finger and the offsets, D its mean
/// over the last kMemory_s of the touch, W the inverse variances of the noise,
/// which moves the left side by sqrt(D'W D). Offsets wander far less in
/// that time than in a touch that has become doubtful.
class HeldTouch {
 public:
  static constexpr double kMemory_s = 3, kReleased = 0.5, kSure = 2;

  /// A frame of a touch, sure or not.
  void Hold(const Eigen::VectorXd& beside_V, double time_s);
  /// Says whether a touch lasts in a frame in which no contact is significant.
  bool Lasts(const Finger& finger, const Eigen::VectorXd& beside_V,
             const Eigen::VectorXd& offsets_V) const;
  void End() { lasts_ = false; }
  /// The clock has gone back by so much.
  void MoveClock(double back_s) { time_s_ -= back_s; }

 private:
  bool lasts_ = false;
  double time_s_ = 0;
  Eigen::VectorXd held_V_;  // beside the free finger
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_OFFSET_BELIEF_H_

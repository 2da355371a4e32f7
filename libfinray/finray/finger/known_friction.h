#ifndef FINRAY_FINGER_KNOWN_FRICTION_H_
#define FINRAY_FINGER_KNOWN_FRICTION_H_

#include "finray/finger/finger.h"

namespace finray {

/// What is known of the friction coefficient of contacts.
struct KnownFriction {
  // A number alone is a coefficient without an error.
  KnownFriction(double coefficient, double std = 0)
      : coefficient(coefficient), std(std) {}

  double coefficient;
  double std;
};

/// Says whether a coefficient is that of the calibration's contacts, within a
/// std of it where the calibration has found it.
bool IsFrictionOf(const ParameterCovariance& calibration, double coefficient);

/// Returns the finger with the covariance that counts for contacts with this
/// friction:
///  - Where the coefficient is the calibration's and was found together with
///    the finger, its errors go with those of the finger. A std above the
///    calibration's adds an error that has nothing to do with the finger.
///  - Otherwise the coefficient is a parameter of its own if it has a std, and
///    none if it has not.
Finger ForFriction(const Finger& finger, const KnownFriction& friction);

}  // namespace finray

#endif  // FINRAY_FINGER_KNOWN_FRICTION_H_

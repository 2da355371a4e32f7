#ifndef FINRAY_SENSING_CONTACT_START_H_
#define FINRAY_SENSING_CONTACT_START_H_

#include <array>

#include "finray/statics/equilibrium.h"

namespace finray {

/// A start for ContactFit: contacts from base to tip, a nearby equilibrium, and
/// the approximate chi2 of a fit from there.
struct ContactStart {
  int count = 0;
  std::array<PointContact, kFittedContacts> contacts;
  double chi2 = 0;
  const LadderState* state = nullptr;
};

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_START_H_

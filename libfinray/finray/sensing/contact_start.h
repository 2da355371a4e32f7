#ifndef FINRAY_SENSING_CONTACT_START_H_
#define FINRAY_SENSING_CONTACT_START_H_

#include <array>

#include "finray/statics/equilibrium.h"

namespace finray {

/// A place for ContactFit to start from: contacts, base to tip, an equilibrium
/// near theirs, and about what chi2 a fit from there would come to.
struct ContactStart {
  int count = 0;
  std::array<PointContact, kFittedContacts> contacts;
  double chi2 = 0;
  const LadderState* state = nullptr;
};

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_START_H_

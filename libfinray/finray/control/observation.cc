#include "finray/control/observation.h"

#include <cmath>

namespace finray {

SeenForce MeanForce(const std::vector<SeenContact>& contacts) {
  SeenForce mean;
  double variance = 0;
  for (const SeenContact& contact : contacts) {
    mean.force_N += contact.normal_N;
    variance += contact.normal_std_N * contact.normal_std_N;
  }
  const double n = static_cast<double>(contacts.size());
  mean.force_N /= n;
  mean.std_N = std::sqrt(variance) / n;
  return mean;
}

}  // namespace finray

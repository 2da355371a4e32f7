#ifndef FINRAY_SENSING_CONTACT_DESCENT_H_
#define FINRAY_SENSING_CONTACT_DESCENT_H_

#include <optional>
#include <vector>

#include "finray/sensing/contact_linearization.h"

namespace finray {

/// Levenberg-Marquardt on chi2(l_c, f_c) of contact_fit.h with an equilibrium
/// solved for every trial: ten times the cost of ContactFit, but chi2 falls
/// with every step. Gauss-Newton without it circles about a minimum where what
/// noise leaves unexplained, times the curvature of the angles over l_c,
/// outweighs the information: in the last bay.
class ContactDescent {
 public:
  /// `most_force_N` bounds f_c. The solver's state is used as scratch.
  ContactDescent(EquilibriumSolver* solver,
                 std::optional<double> circle_radius_mm, double most_force_N)
      : solver_(solver),
        circle_radius_mm_(circle_radius_mm),
        most_force_N_(most_force_N) {}

  /// From `*contacts` to near a minimum. The solver is then in equilibrium with
  /// the contacts. False if there is no equilibrium to start from.
  bool Descend(const LadderState& state, const PackedReadings& measurement,
               std::vector<PointContact>* contacts);

  /// At the end of the last descent; shape and loads are the solver's.
  const ContactLinearization& at() const { return at_; }
  int iterations() const { return iterations_; }

 private:
  std::vector<PointContact> Trial(const std::vector<PointContact>& contacts,
                                  double damping) const;

  EquilibriumSolver* solver_;
  std::optional<double> circle_radius_mm_;
  double most_force_N_;
  int iterations_ = 0;
  ContactLinearization at_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_DESCENT_H_

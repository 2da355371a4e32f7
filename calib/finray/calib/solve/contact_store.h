#ifndef FINRAY_CALIB_SOLVE_CONTACT_STORE_H_
#define FINRAY_CALIB_SOLVE_CONTACT_STORE_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_guess.h"

namespace finray {

/// l_c (mm) and f_c (N) by frame of the logs; NaN where there is none, or none
/// yet.
using Contacts = std::vector<std::array<double, 2>>;

/// The contacts of a problem, which are unknowns beside its parameters, and
/// where they are first looked for.
class ContactStore {
 public:
  /// `problem` must stay in place.
  explicit ContactStore(CalibrationProblem* problem);
  ContactStore(CalibrationProblem* problem, Contacts contacts);

  /// At a fixed address.
  std::array<double, 2>& operator[](int frame) { return contacts_[frame]; }
  const Contacts& all() const { return contacts_; }
  void Set(Contacts contacts) { contacts_ = std::move(contacts); }

  /// Guesses the contacts of these frames where there is none yet, by the
  /// finger as it is now. To be called before StateNear.
  void Guess(const std::vector<int>& frames, ContactGuess::From from);
  /// Has the next Guess make a new table for StateNear if the stiffness has
  /// changed by a tenth since the last: loads in equilibrium go with it.
  void RenewStates();
  void Forget(int frame);
  /// Moves a contact within its bounds.
  void Move(int frame, const Eigen::Vector2d& by);

  /// A state of equilibrium near the frame's contact, from the table of the
  /// last guess; empty without contact. The table is small, and so memory for
  /// states does not grow with the number of frames.
  LadderState StateNear(int frame) const;

 private:
  Eigen::Vector2d Stiffness() const;

  CalibrationProblem& problem_;
  Contacts contacts_;
  std::unique_ptr<const ContactGuess> guess_;
  Eigen::Vector2d guessed_at_;  // logarithms of the stiffness
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_CONTACT_STORE_H_

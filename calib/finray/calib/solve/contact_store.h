#ifndef FINRAY_CALIB_SOLVE_CONTACT_STORE_H_
#define FINRAY_CALIB_SOLVE_CONTACT_STORE_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_guess.h"

namespace finray {

/// l_c (mm) and f_c (N) of each frame of the logs. They are NaN if the frame
/// has no contact or none has been guessed yet.
using Contacts = std::vector<std::array<double, 2>>;

/// Holds the contacts of a problem, which are unknowns beside its parameters,
/// and guesses where they start.
class ContactStore {
 public:
  /// `problem` must stay in place.
  explicit ContactStore(CalibrationProblem* problem);

  /// The contact of a frame. Its address does not change.
  std::array<double, 2>& operator[](int frame) { return contacts_[frame]; }
  const Contacts& all() const { return contacts_; }
  void Set(Contacts contacts) { contacts_ = std::move(contacts); }

  /// Guesses the contacts of those of the frames that have none yet, with the
  /// finger as it is now.
  void Guess(const std::vector<int>& frames, ContactGuess::From from);
  /// Makes StateNear build a new table if the stiffness has changed by a tenth
  /// since the last one. Loads in equilibrium change with the stiffness.
  void RenewStates();
  /// Removes the contact of a frame, so that the next Guess makes a new one.
  void Forget(int frame);
  /// Moves a contact within its bounds.
  void Move(int frame, const Eigen::Vector2d& by);

  /// Returns a state of equilibrium near a contact, from the table of the last
  /// guess, or else from one of the finger as it is at the first call; during a
  /// pass the parameters stay. The state is empty for a NaN place, that of a
  /// frame without contact. The table is small, so memory for states does not
  /// grow with the number of frames. Threads may call it at the same time.
  LadderState StateNear(double arc_mm, double normal_N) const;

 private:
  Eigen::Vector2d Stiffness() const;
  void NewGuess(bool many) const;

  CalibrationProblem& problem_;
  Contacts contacts_;
  // Made when it is needed. The values and logarithms of the stiffness are
  // those that it was made at.
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const ContactGuess> guess_;
  mutable Eigen::VectorXd guessed_at_;
  mutable Eigen::Vector2d stiffness_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_CONTACT_STORE_H_

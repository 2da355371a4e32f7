#include "finray/calib/solve/contact_store.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "finray/io/nan.h"
#include "finray/residuals/parallel_frames.h"

namespace finray {

ContactStore::ContactStore(CalibrationProblem* problem)
    : problem_(*problem),
      contacts_(problem->logs().frames.size(), {kNaN, kNaN}) {}

void ContactStore::Guess(const std::vector<int>& frames,
                         ContactGuess::From from) {
  std::vector<int> wanted;
  for (const int i : frames) {
    if (problem_.frame(i).contact && std::isnan(contacts_[i][0])) {
      wanted.push_back(i);
    }
  }
  if (wanted.empty() && guess_) return;
  auto guess = std::make_unique<const ContactGuess>(
      &problem_, wanted.size() >= ContactGuess::kMany);
  VisitInParallel(wanted.size(), problem_.threads(), *guess,
                  [&](std::size_t k, ContactGuess* local) {
                    const auto place =
                        local->Of(problem_.frame(wanted[k]), from);
                    contacts_[wanted[k]] = {place.arc_mm, place.normal_N};
                  });
  guess_ = std::move(guess);
  guessed_at_ = Stiffness();
}

Eigen::Vector2d ContactStore::Stiffness() const {
  const SharedParameters& shared = problem_.parameters().shared;
  return {shared.ln_front_stiffness, shared.ln_back_stiffness};
}

void ContactStore::RenewStates() {
  if (!guess_) return;
  const Eigen::Vector2d change = Stiffness() - guessed_at_;
  if (change.cwiseAbs().maxCoeff() > 0.1) guess_.reset();
}

void ContactStore::Forget(int frame) { contacts_[frame] = {kNaN, kNaN}; }

void ContactStore::Move(int frame, const Eigen::Vector2d& by) {
  if (!problem_.frame(frame).contact) return;
  auto& [arc_mm, normal_N] = contacts_[frame];
  arc_mm = std::clamp(arc_mm + by[0], 0.0, problem_.finger().front_length_mm);
  normal_N = std::max(0.0, normal_N + by[1]);
}

LadderState ContactStore::StateNear(int frame) const {
  const auto [arc_mm, normal_N] = contacts_[frame];
  if (std::isnan(arc_mm)) return {};
  return guess_->table().StateNear(arc_mm, normal_N);
}

}  // namespace finray

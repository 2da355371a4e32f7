#include "finray/calib/solve/contact_store.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "finray/calib/solve/frame_surface.h"
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
  if (wanted.empty()) return;
  const bool many = wanted.size() >= kFramesForSurface;
  if (!guess_ || guessed_at_ != problem_.Values() ||
      (many && !guess_->many())) {
    NewGuess(many);
  }
  VisitInParallel(wanted.size(), problem_.threads(), *guess_,
                  [&](std::size_t k, ContactGuess* local) {
                    const auto place =
                        local->Of(problem_.frame(wanted[k]), from);
                    contacts_[wanted[k]] = {place.arc_mm, place.normal_N};
                  });
}

void ContactStore::NewGuess(bool many) const {
  guess_ = std::make_unique<const ContactGuess>(&problem_, many);
  guessed_at_ = problem_.Values();
  stiffness_ = Stiffness();
}

Eigen::Vector2d ContactStore::Stiffness() const {
  const SharedParameters& shared = problem_.parameters().shared;
  return {shared.ln_front_stiffness, shared.ln_back_stiffness};
}

void ContactStore::RenewStates() {
  if (!guess_) return;
  const Eigen::Vector2d change = Stiffness() - stiffness_;
  if (change.cwiseAbs().maxCoeff() > 0.1) guess_.reset();
}

void ContactStore::Forget(int frame) { contacts_[frame] = {kNaN, kNaN}; }

void ContactStore::Move(int frame, const Eigen::Vector2d& by) {
  if (!problem_.frame(frame).contact) return;
  auto& [arc_mm, normal_N] = contacts_[frame];
  arc_mm = std::clamp(arc_mm + by[0], 0.0, problem_.finger().front_length_mm);
  normal_N = std::max(0.0, normal_N + by[1]);
}

LadderState ContactStore::StateNear(double arc_mm, double normal_N) const {
  if (std::isnan(arc_mm)) return {};
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!guess_) NewGuess(false);
  return guess_->table().StateNear(arc_mm, normal_N);
}

}  // namespace finray

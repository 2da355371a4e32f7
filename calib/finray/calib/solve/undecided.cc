#include "finray/calib/solve/undecided.h"

#include <cmath>
#include <limits>
#include <map>

#include "finray/calib/solve/frame_pass.h"

namespace finray {
namespace {

// Fits the frames as touching or as free. Returns chi2 of each, infinite where
// the model cannot be evaluated.
std::map<int, double> Chi2As(bool contact, const std::vector<int>& frames,
                             CalibrationProblem* problem,
                             ContactStore* contacts) {
  for (const int i : frames) {
    contacts->Forget(i);
    problem->Decide(i, contact);
  }
  std::map<int, double> chi2;
  FitContacts(frames, problem, contacts, [&](int i, const LinearizedFrame& at) {
    chi2[i] =
        at.rows.empty() ? std::numeric_limits<double>::infinity() : 2 * at.cost;
  });
  return chi2;
}

// Returns chi2 of the force, for which a free frame has no residual.
double Chi2OfForce(const CalibrationProblem& problem, int i) {
  const Plan& plan = problem.plan();
  const CalibrationFrame& frame = problem.frame(i);
  const MeasuredForce force = frame.Force();
  if (!force.IsMeasured() || !plan.ForceZeroIsKnown()) return 0;
  const double std_N = frame.ForceStd_N(plan) * frame.readings_std_times;
  double rho[3] = {std::pow(force.magnitude_N / std_N, 2)};
  if (const auto loss = MakeLoss(plan)) loss->Evaluate(rho[0], rho);
  return rho[0];
}

}  // namespace

void DecideContacts(const std::vector<int>& frames, CalibrationProblem* problem,
                    ContactStore* contacts) {
  std::vector<int> undecided;
  for (const int i : frames) {
    if (problem->frame(i).undecided) undecided.push_back(i);
  }
  if (undecided.empty()) return;
  const auto free = Chi2As(false, undecided, problem, contacts);
  const auto touching = Chi2As(true, undecided, problem, contacts);
  for (const int i : undecided) {
    const bool contact =
        free.at(i) + Chi2OfForce(*problem, i) - touching.at(i) > kTouchChi2;
    problem->Decide(i, contact);
    if (!contact) contacts->Forget(i);
  }
}

}  // namespace finray

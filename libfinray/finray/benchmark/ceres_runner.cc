#include <algorithm>
#include <limits>

#include "finray/benchmark/runner.h"
#include "finray/sensing/frame_problem.h"

namespace finray {
namespace {

class CeresFrames : public SensingRunner {
 public:
  CeresFrames(const BenchmarkCase& c, const Discretization& discretization,
              EquilibriumForm form)
      : SensingRunner(c, discretization),
        form_(form),
        problem_(c.finger, c.scene, discretization, form,
                 std::numeric_limits<double>::max()) {}

  void Start(int lead_in) override {
    StartAt(lead_in);
    Run(lead_in, 1);
  }

  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      FrameAnswer& answer = answers_[k];
      const ContactStart start = {last_.count, last_.contacts, 0, &last_.state};
      answer.solved =
          problem_.Fit(start, case_.frames[first + k].readings, &found_);
      answer.contacts.assign(found_.contacts.begin(),
                             found_.contacts.begin() + found_.count);
      answer.tip_pose = found_.tip_pose;
      answer.iterations = problem_.iterations();
      if (answer.solved) {
        std::swap(last_, found_);
      } else {
        StartAt(first + k);
      }
    }
  }

  int unknowns() const override {
    // Base loads and rib tensions are unknowns of the weighted form alone.
    const int loads = 6 + static_cast<int>(case_.finger.ribs.size());
    return 2 * last_.count + (form_ == EquilibriumForm::kWeighted ? loads : 0);
  }

 private:
  void StartAt(int frame) {
    const auto& contacts = case_.frames[frame].contacts;
    model_.Solve(contacts);
    last_.count = static_cast<int>(contacts.size());
    std::copy(contacts.begin(), contacts.end(), last_.contacts.begin());
    last_.state = model_.state();
  }

  EquilibriumForm form_;
  FrameProblem problem_;
  ContactSolution last_, found_;
};

}  // namespace

RunnerMaker CeresFrameRunner(const Discretization& discretization,
                             EquilibriumForm form) {
  return MakerOf<CeresFrames>(discretization, form);
}

}  // namespace finray

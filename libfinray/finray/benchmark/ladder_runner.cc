#include "finray/benchmark/answers.h"

namespace finray {
namespace {

class LadderForward : public Runner {
 public:
  LadderForward(const BenchmarkCase& c, const Discretization& discretization,
                double tolerance, bool cold)
      : case_(c),
        solver_(c.finger, discretization),
        cold_(cold),
        answers_(RoomForAnswers(c)) {
    solver_.set_tolerance(tolerance);
  }

  void Start(int lead_in) override {
    solver_.Reset();
    touch_ = {};
    Run(lead_in, 1);
  }

  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      const BenchmarkFrame& frame = case_.frames[first + k];
      FrameAnswer& answer = answers_[k];
      if (cold_) solver_.Reset();
      if (case_.scene.object) {
        if (cold_) touch_.contacts.clear();
        touch_ = SolveObjectContact(*case_.scene.object, frame.object, 0,
                                    &solver_, touch_.contacts);
        answer.solved = touch_.status == ObjectContactStatus::kContact;
        answer.contacts = touch_.contacts;
      } else {
        answer.solved = solver_.Solve(frame.contacts);
        answer.contacts = frame.contacts;
      }
      if (!answer.solved) continue;
      answer.gauges_rad = solver_.outputs().head(solver_.model().gauges());
      answer.tip_pose = solver_.tip_pose();
      answer.iterations = solver_.iterations();
    }
  }

  FrameAnswer Answer(int k) override { return answers_[k]; }
  int unknowns() const override {
    return solver_.unknowns() + 2 * static_cast<int>(touch_.contacts.size());
  }

 private:
  const BenchmarkCase& case_;
  EquilibriumSolver solver_;
  bool cold_;
  ObjectContact touch_;
  std::vector<FrameAnswer> answers_;
};

}  // namespace

std::unique_ptr<Runner> MakeLadderForward(const BenchmarkCase& c,
                                          const Discretization& discretization,
                                          double tolerance, bool cold) {
  return std::make_unique<LadderForward>(c, discretization, tolerance, cold);
}

}  // namespace finray

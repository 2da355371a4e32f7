#include "finray/benchmark/answers.h"
#include "finray/sensing/fast/contact_fit.h"

namespace finray {
namespace {

class Fit : public Runner {
 public:
  Fit(const BenchmarkCase& c, const Discretization& discretization,
      double tolerance)
      : case_(c),
        start_(c.finger, discretization),
        gauges_(c.finger, discretization),
        fit_(c.finger, discretization, MeasuredRadius(c.scene)),
        answers_(RoomForAnswers(c)) {
    fit_.set_tolerance(tolerance);
  }

  void Start(int lead_in) override {
    contacts_ = case_.frames[lead_in].contacts;
    start_.Solve(contacts_);
    fit_.set_state(start_.state());
    Run(lead_in, 1);
  }

  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      const PackedReadings& measured = case_.frames[first + k].measurement;
      FrameAnswer& answer = answers_[k];
      answer.solved =
          fit_.Follow(measured.values, measured.weights, &contacts_);
      answer.contacts = contacts_;
      answer.tip_pose = fit_.tip_pose();
      answer.iterations = fit_.iterations();
      if (!answer.solved) {
        start_.Solve(case_.frames[first + k].contacts);
        contacts_ = case_.frames[first + k].contacts;
        fit_.set_state(start_.state());
      }
    }
  }

  FrameAnswer Answer(int k) override { return gauges_.Completed(answers_[k]); }
  int unknowns() const override {
    return start_.unknowns() + 2 * static_cast<int>(contacts_.size());
  }

 private:
  const BenchmarkCase& case_;
  EquilibriumSolver start_;
  GaugesAt gauges_;
  ContactFit fit_;
  std::vector<PointContact> contacts_;
  std::vector<FrameAnswer> answers_;
};

}  // namespace

std::unique_ptr<Runner> MakeFit(const BenchmarkCase& c,
                                const Discretization& discretization,
                                double tolerance) {
  return std::make_unique<Fit>(c, discretization, tolerance);
}

}  // namespace finray

#include "finray/benchmark/runner.h"
#include "finray/objects/circle_centre.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/fast/frame_group_fit.h"

namespace finray {
namespace {

class LadderForward : public Runner {
 public:
  LadderForward(const BenchmarkCase& c, const Discretization& discretization,
                double tolerance, bool cold)
      : Runner(c), solver_(c.finger, discretization), cold_(cold) {
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

  int unknowns() const override {
    return solver_.unknowns() + 2 * static_cast<int>(touch_.contacts.size());
  }

 private:
  EquilibriumSolver solver_;
  bool cold_;
  ObjectContact touch_;
};

class FrameByFrame : public SensingRunner {
 public:
  FrameByFrame(const BenchmarkCase& c, const Discretization& discretization,
               double tolerance)
      : SensingRunner(c, discretization),
        fit_(c.finger, discretization, MeasuredRadius(c.scene)) {
    fit_.set_tolerance(tolerance);
  }

  void Start(int lead_in) override {
    StartAt(lead_in);
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
      if (!answer.solved) StartAt(first + k);
    }
  }

  int unknowns() const override {
    return model_.unknowns() + 2 * static_cast<int>(contacts_.size());
  }

 private:
  void StartAt(int frame) {
    contacts_ = case_.frames[frame].contacts;
    model_.Solve(contacts_);
    fit_.set_state(model_.state());
  }

  ContactFit fit_;
  std::vector<PointContact> contacts_;
};

class InLanes : public SensingRunner {
 public:
  InLanes(const BenchmarkCase& c, const Discretization& discretization,
          double tolerance)
      : SensingRunner(c, discretization),
        fit_(c.finger, discretization, c.scene.friction_coefficient),
        angles_(c.finger.gauges.size(), c.frames.size()),
        weights_(c.finger.gauges.size(), c.frames.size()),
        fits_(kStretchFrames) {
    fit_.set_tolerance(tolerance);
    for (std::size_t i = 0; i < c.frames.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      angles_.col(column) = c.frames[i].measurement.values;
      weights_.col(column) = c.frames[i].measurement.weights;
    }
  }

  void Start(int lead_in) override {
    const PointContact& contact = case_.frames[lead_in].contacts.at(0);
    model_.Solve({contact});
    fit_.Start(model_.state(), contact);
    Run(lead_in, 1);
  }

  void Run(int first, int count) override {
    fit_.Fit(angles_.middleCols(first, count),
             weights_.middleCols(first, count), fits_.data());
  }

  FrameAnswer Answer(int k) override {
    const FrameFit& fit = fits_[k];
    const double friction = case_.scene.friction_coefficient;
    answers_[k] = {fit.converged,
                   {{fit.arc_mm, fit.normal_N, friction}},
                   {},
                   fit.tip_pose,
                   fit.iterations};
    return SensingRunner::Answer(k);
  }

  int unknowns() const override { return model_.unknowns() + 2; }

 private:
  FrameGroupFit fit_;
  Eigen::MatrixXd angles_, weights_;  // a column a frame
  std::vector<FrameFit> fits_;
};

}  // namespace

RunnerMaker LadderForwardRunner(const Discretization& discretization,
                                double tolerance, bool cold) {
  return MakerOf<LadderForward>(discretization, tolerance, cold);
}

RunnerMaker ContactFitRunner(const Discretization& discretization,
                             double tolerance) {
  return MakerOf<FrameByFrame>(discretization, tolerance);
}

RunnerMaker FrameGroupRunner(const Discretization& discretization,
                             double tolerance) {
  return MakerOf<InLanes>(discretization, tolerance);
}

}  // namespace finray

#include "finray/calib/solve/linearization.h"

#include <algorithm>

namespace finray {
namespace {

constexpr Eigen::Index kMostWaiting = 128;

}  // namespace

Linearization::Linearization(int parameters, std::size_t most_frames)
    : pulls(parameters, static_cast<Eigen::Index>(most_frames)),
      gradient(Eigen::VectorXd::Zero(parameters)) {
  contact_leverage.fill(0);
}

void Linearization::Add(int frame, int log, const LinearizedFrame& at) {
  const Eigen::VectorXd weighted = at.WeightedResiduals();
  const LinearizedFrame::Rows& c = at.reduced;
  const Eigen::VectorXd pull = c.transpose() * weighted;
  pulls.col(static_cast<Eigen::Index>(frames.size())) = pull.cast<float>();
  gradient += pull;
  cost += at.cost - at.move.decrease;
  frames.push_back(frame);
  if (log != log_) {
    Sum();
    log_ = log;
    auto [of_log, is_new] = information.try_emplace(log);
    if (is_new) {
      of_log->second.fill(Eigen::MatrixXd::Zero(c.cols(), c.cols()));
    }
  }
  const Eigen::Matrix2d contact =
      PseudoInverse(at.by_contact.transpose() * at.by_contact);
  const auto count = static_cast<Eigen::Index>(at.rows.size());
  for (Eigen::Index i = 0; i < count;) {
    const ResidualFamily family = at.rows[i].family;
    Eigen::Index end = i;
    for (; end < count && at.rows[end].family == family; ++end) {
      const auto e = at.by_contact.row(end);
      contact_leverage[static_cast<int>(family)] +=
          e.dot(contact * e.transpose());
      rows.push_back({frame, family,
                      static_cast<std::int16_t>(at.rows[end].gauge),
                      static_cast<float>(at.rows[end].std_V)});
      residuals.push_back(at.residuals[end]);
      weighted_residuals.push_back(weighted[end]);
    }
    Waiting& waiting = waiting_[static_cast<int>(family)];
    if (waiting.count + end - i > waiting.rows.cols()) {
      Sum();
      waiting.rows.resize(c.cols(), std::max(kMostWaiting, end - i));
    }
    waiting.rows.middleCols(waiting.count, end - i) =
        c.middleRows(i, end - i).transpose();
    waiting.count += end - i;
    i = end;
  }
}

// Adds the products of the waiting rows to the lower triangles.
void Linearization::Sum() {
  for (int i = 0; i < kResidualFamilies; ++i) {
    Waiting& waiting = waiting_[i];
    if (waiting.count == 0) continue;
    information.at(log_)[i].selfadjointView<Eigen::Lower>().rankUpdate(
        waiting.rows.leftCols(waiting.count));
    waiting.count = 0;
  }
}

void Linearization::Finish() {
  Sum();
  waiting_ = {};
  for (auto& [log, of_log] : information) {
    for (Eigen::MatrixXd& sum : of_log) {
      sum.triangularView<Eigen::StrictlyUpper>() = sum.transpose();
    }
  }
  pulls.conservativeResize(Eigen::NoChange,
                           static_cast<Eigen::Index>(frames.size()));
}

Eigen::MatrixXd Linearization::Information() const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (int i = 0; i < kResidualFamilies; ++i) sum += InformationOfFamily(i);
  return sum;
}

Eigen::MatrixXd Linearization::InformationOfGroup(int group) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (const Eigen::MatrixXd& part : information.at(group)) sum += part;
  return sum;
}

Eigen::MatrixXd Linearization::InformationOfFamily(int family) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (const auto& [log, of_log] : information) sum += of_log[family];
  return sum;
}

}  // namespace finray

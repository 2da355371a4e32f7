#include "finray/calib/solve/linearization.h"

namespace finray {

Linearization::Linearization(int parameters, std::size_t most_frames)
    : pulls(parameters, static_cast<Eigen::Index>(most_frames)) {
  for (auto& information : information_by_family) {
    information.setZero(parameters, parameters);
  }
  contact_leverage.fill(0);
}

void Linearization::Add(int frame, int log, const LinearizedFrame& at) {
  const Eigen::VectorXd weighted = at.WeightedResiduals();
  const Eigen::MatrixXd& c = at.reduced;
  pulls.col(static_cast<Eigen::Index>(frames.size())) =
      (c.transpose() * weighted).cast<float>();
  frames.push_back(frame);
  const Eigen::Matrix2d contact =
      PseudoInverse(at.by_contact.transpose() * at.by_contact);
  const auto count = static_cast<Eigen::Index>(at.rows.size());
  const Eigen::Index n = c.cols();
  const auto of_log =
      information_by_log.try_emplace(log, Eigen::MatrixXd::Zero(n, n));
  AddSquare(c, &of_log.first->second);
  for (Eigen::Index i = 0; i < count;) {
    const ResidualFamily family = at.rows[i].family;
    Eigen::Index end = i;
    for (; end < count && at.rows[end].family == family; ++end) {
      const auto e = at.by_contact.row(end);
      contact_leverage[static_cast<int>(family)] +=
          e.dot(contact * e.transpose());
      rows.push_back(
          {frame, family, static_cast<std::int16_t>(at.rows[end].gauge)});
      residuals.push_back(at.residuals[end]);
      weighted_residuals.push_back(weighted[end]);
    }
    const auto of_family = c.middleRows(i, end - i);
    AddSquare(of_family, &information_by_family[static_cast<int>(family)]);
    i = end;
  }
}

void Linearization::Finish() {
  pulls.conservativeResize(Eigen::NoChange,
                           static_cast<Eigen::Index>(frames.size()));
}

Eigen::MatrixXd Linearization::Information() const {
  Eigen::MatrixXd sum = information_by_family[0];
  for (int i = 1; i < kResidualFamilies; ++i) sum += information_by_family[i];
  return sum;
}

}  // namespace finray

#ifndef FINRAY_FINGER_CORRELATIONS_YAML_H_
#define FINRAY_FINGER_CORRELATIONS_YAML_H_

#include <Eigen/Core>
#include <string>

#include "finray/io/yaml_map.h"

namespace finray {

// Covariances in YAML: `std` and `correlations`, the lower triangle up to the
// diagonal. Readers throw InputError for a wrong number of numbers and for
// numbers that are no covariance.

/// An eigenvalue of correlations may be this far below 0, as rounding them to
/// six digits can make it.
constexpr double kCorrelationRounding = 1e-6;

/// `what` is what each number is of: "a parameter".
Eigen::VectorXd ReadStd(const YamlMap& yaml, const std::string& key,
                        std::size_t count, const std::string& what);
/// Left out, all are 0.
Eigen::MatrixXd ReadCorrelations(const YamlMap& yaml, std::size_t count,
                                 const std::string& what);

/// "[0.1, 0.2]"; it reads back as the same doubles.
std::string NumberList(const Eigen::VectorXd& numbers);
/// The rows of the lower triangle, each a line behind `indent` and a dash.
std::string CorrelationRows(const Eigen::MatrixXd& correlations,
                            const std::string& indent);

}  // namespace finray

#endif  // FINRAY_FINGER_CORRELATIONS_YAML_H_

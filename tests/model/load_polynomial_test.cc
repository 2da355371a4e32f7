#include "finray/model/load_polynomial.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "finray/ladder/instruction_set.h"

namespace finray {
namespace {

// Every compilation sums up the same products.
TEST(LoadPolynomialTest, AllInstructionSetsAgreeWithThePlainSum) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  // Enough values for each number of registers at a time.
  constexpr int kArcTerms = 5, kValues = 60;
  const int force_terms[kArcTerms] = {4, 4, 3, 0, 1};
  std::vector<double> c(12 * kValues);
  for (double& one : c) one = draw(generator);
  PolynomialBasis basis;
  for (int d = 0; d < 2; ++d) {
    for (int i = 0; i < PolynomialBasis::kMostTerms; ++i) {
      for (double& one : basis.by[d][i]) one = draw(generator);
    }
  }
  const int orders[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const LoadPolynomial polynomial{kArcTerms, force_terms, kValues, c.data()};
  for (int set = 0; set < InstructionSets(); ++set) {
    double gradients[3 * kValues], values[kValues];
    EvaluateGradients(polynomial, basis, gradients, set);
    EvaluateValues(polynomial, basis, values, set);
    for (int v = 0; v < kValues; ++v) {
      for (int d = 0; d < 3; ++d) {
        double sum = 0;
        const double* its = &c[v];
        for (int i = 0; i < kArcTerms; ++i) {
          for (int j = 0; j < force_terms[i]; ++j, its += kValues) {
            sum += basis.by[orders[d][0]][i][0] * basis.by[orders[d][1]][j][1] *
                   *its;
          }
        }
        EXPECT_NEAR(gradients[d * kValues + v], sum, 1e-13) << set;
        if (d == 0) {
          EXPECT_NEAR(values[v], sum, 1e-13) << set;
        }
      }
    }
  }
}

}  // namespace
}  // namespace finray

// Point contacts against the continuum equations solved by an independent
// method (scripts/make_reference.py), on the path from the unloaded finger.

#include "statics/continuum_reference.h"

#include <gtest/gtest.h>

namespace finray {
namespace {

void ExpectAgreement(const Discretization& discretization, double bound,
                     const std::string& title) {
  ContinuumReference reference("point_contacts.csv");
  ASSERT_GT(reference.rows(), 70u);
  ErrorsByGroup errors;
  for (std::size_t row = 0; row < reference.rows(); ++row) {
    const std::string name = reference.Text("case", row);
    const std::string group = reference.Text("group", row);
    SCOPED_TRACE(name);
    EquilibriumSolver solver(reference.FingerOf(row), discretization);
    const bool solved = solver.Solve(reference.Contacts(row));
    EXPECT_TRUE(solved);
    if (!solved) {
      errors.AddFailure(group);
      continue;
    }
    const double error = reference.Error(row, solver);
    EXPECT_LT(error, bound);
    errors.Add(group, name, error);
  }
  errors.Print(title);
}

TEST(ContinuumReferenceTest, DefaultMesh) {
  ExpectAgreement({}, 1e-6, "default mesh");
}

TEST(ContinuumReferenceTest, FineMesh) {
  ExpectAgreement({Scheme::kTaylor, 96}, 1e-8, "96 Taylor elements");
}

}  // namespace
}  // namespace finray

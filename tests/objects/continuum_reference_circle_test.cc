// Circles against the continuum equations solved by an independent method
// (scripts/make_reference.py), moved in from first touch.

#include <gtest/gtest.h>

#include "finray/objects/object_contact.h"
#include "statics/continuum_reference.h"

namespace finray {
namespace {

void ExpectAgreement(const Discretization& discretization, double bound,
                     const std::string& title) {
  ContinuumReference reference("circle_contacts.csv");
  ASSERT_GT(reference.rows(), 20u);
  ErrorsByGroup errors;
  for (std::size_t row = 0; row < reference.rows(); ++row) {
    const std::string name = reference.Text("case", row);
    SCOPED_TRACE(name);
    const PointContact expected = reference.Contacts(row).at(0);
    const RigidObject circle{
        Outline(CircleOutline{reference.Parsed("radius_mm", row)}), {}};
    EquilibriumSolver solver(reference.FingerOf(row), discretization);
    const ObjectContact found =
        SolveObjectContact(circle,
                           {{reference.Number("object_x_mm", row),
                             reference.Number("object_y_mm", row)}},
                           expected.friction, &solver);
    EXPECT_EQ(found.status, ObjectContactStatus::kContact);
    EXPECT_EQ(found.contacts.size(), 1u);
    if (found.contacts.size() != 1) {
      errors.AddFailure("circle");
      continue;
    }
    const PointContact contact = found.contacts[0];
    const double error = std::max(
        {reference.Error(row, solver),
         std::abs(contact.arc_mm - expected.arc_mm) /
             solver.model().finger().front_length_mm,
         std::abs(contact.normal_N - expected.normal_N) / expected.normal_N});
    EXPECT_LT(error, bound);
    errors.Add("circle", name, error);
  }
  errors.Print(title);
}

TEST(ContinuumReferenceCircleTest, DefaultMesh) {
  ExpectAgreement({}, 1e-6, "default mesh");
}

TEST(ContinuumReferenceCircleTest, FineMesh) {
  ExpectAgreement({Scheme::kTaylor, 96}, 1e-8, "96 Taylor elements");
}

}  // namespace
}  // namespace finray

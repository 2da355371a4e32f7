#ifndef FINRAY_ESTIMATION_CONTACT_SEARCH_H_
#define FINRAY_ESTIMATION_CONTACT_SEARCH_H_

#include <memory>
#include <optional>
#include <vector>

#include "finray/estimation/contact_solution.h"
#include "finray/estimation/found_solutions.h"
#include "finray/estimation/frame_problem.h"
#include "finray/estimation/iteration_budget.h"
#include "finray/estimation/packed_readings.h"
#include "finray/estimation/pair_profile.h"
#include "finray/estimation/row_fit.h"
#include "finray/estimation/search_tables.h"
#include "finray/scene/scene.h"

namespace finray {

/// The solver that minimises chi2 from a start.
enum class FrameMethod {
  kFast,           ///< RowFit; tests prove it equal to kCeresReduced.
  kCeresReduced,   ///< FrameProblem, equilibrium eliminated.
  kCeresWeighted,  ///< FrameProblem, equilibrium as residual blocks.
};
/// Returns "fast", "ceres reduced" or "ceres weighted".
const char* FrameMethodName(FrameMethod method);

/// Finds the contacts that explain a frame, without a guess by the caller. It
/// minimises chi2 from the best starts of a table, and from all further starts
/// that might lead to a rival. A rival is another solution that explains the
/// frame about as well. Two contacts start from the pairs of the frame before
/// where there are some (warm start). RowFit fits one contact on a surface.
/// Where that does not serve, and for two contacts, it solves the equilibria.
class ContactSearch {
 public:
  static constexpr double kWithinNoise = FoundSolutions::kWithinNoise;
  /// Readings without noise leave a chi2 below this. They show every digit of
  /// an estimate, so a search solves their equilibria.
  static constexpr double kNoiseless = 1e-3;
  /// Noise may bring a rival from so far, in chi2, to within kWithinNoise.
  static constexpr double kSuspect = 40;

  /// `tables` are those of another search with the same arguments, or null.
  /// Throws InputError for a finger without an unloaded equilibrium.
  ContactSearch(const Finger& finger, const Scene& scene,
                const Discretization& discretization,
                FrameMethod method = FrameMethod::kFast,
                std::shared_ptr<const SearchTables> tables = nullptr);
  ContactSearch(const ContactSearch&) = delete;
  ContactSearch& operator=(const ContactSearch&) = delete;

  /// Makes what searches would make when they first need it.
  void Prepare();

  /// Begins a frame. Its searches share Scene::search_iteration_limit. A search
  /// for two contacts goes on from the pairs that the frame before has left.
  /// `row` must stay in place.
  void Begin(const Measurements& row);
  /// The next frame does not follow the last one.
  void Forget();
  /// Searches with one or two contacts. Returns false if no start converged. A
  /// contact with less than `least_force_N` is none. If IsDoubted, the table's
  /// starts end with the first pair that explains the frame, and all with a
  /// number of iterations.
  bool Search(int contacts, const PackedReadings& packed,
              double least_force_N = 0);
  /// Returns true if the gauges of a frame do not tell whether there are two
  /// contacts: with `contacts: auto`, as many unknowns as readings. Whatever
  /// pair is found is then unobservable.
  bool IsDoubted(const PackedReadings& packed) const;

  /// How the last search of a frame went.
  enum class Course {
    kSearched,   ///< From all starts.
    kContinued,  ///< From the pairs of the frame before.
    /// From the pairs of the frame before, and then a fit found a new pair. It
    /// is the best pair, or its chi2 is within kSuspect of the best one. The
    /// frames since the last kSearched were not tried with it.
    kSurprised,
  };
  Course course() const { return course_; }

  /// chi2 of the finger without a contact.
  double FreeChi2(const Measurements& row);

  /// A search of this frame was ended by the limit, with starts left to try.
  bool ended() const { return budget_.ended(); }

  // Results of the last successful search.

  const ContactSolution& best() const { return found_.best(); }
  const ContactSolution* rival() const { return found_.rival(); }
  /// The best contact at each place of the table (GaugeTable::Profile) that may
  /// be a rival or belong to a valley; the others have an infinite chi2 or one
  /// that is too large. Of two contacts, the places of PairProfile, and none if
  /// IsDoubted. Of one contact, empty without gauges.
  const std::vector<ContactStart>& profile() const { return profile_; }
  /// Number of iterations of all fits of the last search.
  int iterations() const { return budget_.spent(); }

  /// Says whether noise plausibly makes chi2 this large. Without degrees of
  /// freedom, says whether chi2 is nearly zero.
  static bool IsExplained(double chi2, int dof);

  /// Says whether a contact is on a bound of the search: at an end of the beam
  /// or at the largest force.
  bool OnBound(double arc_mm, double normal_N) const {
    return found_.OnBound(arc_mm, normal_N);
  }

  /// The friction of the contacts of the searches that follow; the scene's at
  /// first. Starts come from the table with the scene's.
  void set_friction(double friction) {
    fit_.set_friction(friction);
    if (problem_) problem_->set_friction(friction);
  }
  double friction() const { return fit_.friction(); }

  const std::shared_ptr<const SearchTables>& tables() const { return tables_; }
  const GaugeTable& table() const { return tables_->table(); }
  /// The largest credible force: the scene's force_max_N, by default
  /// table().heaviest_N().
  double most_force_N() const { return found_.most_force_N(); }

 private:
  // Says whether the surface serves: its contacts have the scene's friction.
  bool OnSurface() const;
  void SearchOne(const PackedReadings& packed);
  void SearchPairs(const PackedReadings& packed, double least_force_N);
  // Fits from the pairs of the frame before. Returns false, and keeps nothing,
  // where only a search can tell what explains the frame: there are none, the
  // contacts have jumped, or chi2 has risen.
  bool Continue(double least_force_N);
  // Fits from one start of the table, another one in every frame.
  void TryNextPair(const PackedReadings& packed);
  // Rows of the profile need not reach beyond `most_chi2`.
  void FindStarts(const PackedReadings& packed, double most_chi2);
  void FindPairStarts(const PackedReadings& packed);
  // Fits from the starts of a profile that reaches to `most_chi2`. Returns how
  // far it must reach; if that is farther, not all starts are tried.
  double TryStarts(const PackedReadings& packed, double most_chi2);
  // Says whether a start can still win or be a rival.
  bool Matters(const ContactStart& start, double within_chi2) const;
  // Says whether the best pair is all that can be known of a frame.
  bool IsEnough(const PackedReadings& packed, double least_force_N) const;
  // Profiles the best pair, and fits from where its profile has other minima,
  // until they lead to no better one. The profile is then that of the best
  // pair.
  void ProfileBest();
  // Fits from rows of the table that the solutions found do not account for:
  // from all of them where minima are `close`, else from those beside which
  // chi2 changes too sharply for the table to show a minimum between rows.
  void SearchRows(bool close);
  // Fits from places up to a row's spacing away from the best solution.
  void SearchBeside();
  // Fits from the other forces of the rows beside the best solution at which
  // the table's chi2 has a minimum.
  void SearchForces(const PackedReadings& packed);
  // Says whether a solution is nearer to a row than its neighbours are.
  bool IsBeside(std::size_t row) const;
  // Says whether the search may have missed a minimum within noise near a row
  // whose distance in std differs from a neighbour's by least_rise or more.
  bool Hides(std::size_t row, double least_rise) const;
  // Fits from a start and keeps the solution, if there is room for one.
  void TryFit(const ContactStart& start);
  // Both fit from a start and fill in the next solution. Fit goes by the
  // surface where it can.
  bool Fit(const ContactStart& start);
  // With `known`, a solution is there already if it does not converge.
  bool FitEquilibria(const ContactStart& start, int most_iterations,
                     bool known = false);

  std::shared_ptr<const SearchTables> tables_;
  FoundSolutions found_, before_;  // in this frame, and pairs of the last one
  RowFit fit_;
  std::optional<FrameProblem> problem_;  // if Ceres solves
  IterationBudget budget_;
  Course course_ = Course::kSearched;
  std::vector<ContactStart> profile_, starts_;  // of one contact
  std::vector<ContactStart> pair_starts_;       // still to try
  PairProfile pair_profile_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_CONTACT_SEARCH_H_

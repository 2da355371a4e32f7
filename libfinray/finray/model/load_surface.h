#ifndef FINRAY_MODEL_LOAD_SURFACE_H_
#define FINRAY_MODEL_LOAD_SURFACE_H_

#include <array>
#include <memory>
#include <vector>

#include "finray/finger/mesh.h"
#include "finray/model/load_cell.h"
#include "finray/model/load_polynomial.h"

namespace finray {

/// Values of a finger's equilibria as functions of the load (l_c, f_c) of one
/// contact. Between the places where a beam changes, an equilibrium is an
/// analytic function of the load. So each cell of the surface has polynomials
/// of Chebyshev T,
///
///   v(l, f) = sum_ij c_ij T_i(u) T_j(w),    u, w = -1 .. 1 across the cell,
///
/// whose coefficients fall off geometrically: a dozen in either direction leave
/// out no more than rounding, and fewer what the user allows.
/// docs/decisions/0019-a-load-surface.md has figures.
///
/// A cell is made when it is first needed, from some hundred equilibria. Where
/// the last coefficients are not small, it is made again with as many as their
/// fall says, or halved. All threads may use a surface at once; its values do
/// not depend on who made a cell.
class LoadSurface {
 public:
  struct Domain {
    /// Rising. Between two of these the finger is smooth along l_c.
    std::vector<double> arcs_mm;
    /// Rising, from 0.
    std::vector<double> forces_N;
  };
  /// The loads of a contact on the front beam, up to `heaviest_N`. Equilibria
  /// change along l_c at the nodes of the mesh, and gauges of the front beam
  /// feel on which side of their ends a contact lies. A mesh with many elements
  /// a bay would need too many cells: nothing lies in its domain.
  static Domain DomainOf(const Finger& finger, const BeamMesh& front,
                         double heaviest_N);

  LoadSurface(Domain domain, LoadValues values);

  /// A load and the cell that holds it.
  class Place {
   public:
    /// About how far the values of the first group may be off, in units of
    /// their resolution.
    double error() const { return cell_->error(); }

   private:
    friend class LoadSurface;
    const LoadCell* cell_ = nullptr;
    PolynomialBasis basis_;
  };

  /// Finds the cell of a load, and makes it if need be. Returns false outside
  /// the domain or where there is no equilibrium.
  bool Locate(double arc_mm, double normal_N, Place* place) const;

  /// Makes all cells on the caller's thread, for those who cannot wait later.
  /// Another estimator may be at work on the other threads.
  void MakeAll() const;
  /// Makes the cells of these loads (arc_mm, normal_N), side by side on the
  /// threads of the caller's arena. Threads that come to a new cell together
  /// would wait for each other.
  void MakeFor(const std::vector<std::array<double, 2>>& loads) const;

  /// Evaluates a group. `values` has room for LoadPolynomial::Padded(its size).
  void Values(const Place& place, int group, double* values) const;
  /// The values of a group and their derivatives by l_c (mm) and f_c (N) in the
  /// order of EvaluateGradients, 3 x LoadPolynomial::Padded(its size).
  void Gradients(const Place& place, int group, double* gradients) const;

 private:
  // The cell of the domain that holds a load; cells_.size() outside.
  std::size_t CellOf(double arc_mm, double normal_N) const;

  Domain domain_;
  LoadValues values_;
  std::vector<std::unique_ptr<LoadCell>> cells_;  // by arc, then by force
};

}  // namespace finray

#endif  // FINRAY_MODEL_LOAD_SURFACE_H_

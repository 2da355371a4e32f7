#ifndef FINRAY_IO_UNITS_H_
#define FINRAY_IO_UNITS_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// What a unit measures. Columns without a unit have kNone.
enum class Dimension {
  kNone,
  kVoltage,
  kForce,
  kLength,
  kAngle,
  kTorque,  ///< of no column of finray's, but force sensors write it
  kTime,
  kTemperature
};

/// value in V, N, mm, rad, s or deg C = number * multiply / divide + shift.
/// A power of ten is one of the two factors, so that 12.3 mV is the double
/// nearest to 0.0123 V.
struct Unit {
  std::string name;
  Dimension dimension = Dimension::kNone;
  double multiply = 1, divide = 1, shift = 0;
};

/// Returns the unit with this name (mV, gf, inch, ...; "µ" and "μ" are u, "°"
/// is deg, "N mm", "N.mm", "N*mm" and "N-mm" are Nmm), or nothing. The
/// list is scripts/import/units.inc, which finray_import reads too.
std::optional<Unit> FindUnit(std::string_view name);

/// Returns the unit that a file means by a word beside or below a header: those
/// of FindUnit, and words such as g for gf.
std::optional<Unit> FindUnitInFile(std::string_view word);

/// The unit in the name of a frame column: V of gauge_1_V. It is kNone for a
/// column without one.
Unit UnitOfColumn(const std::string& column);

/// The names of all units of a dimension.
std::vector<std::string> UnitNames(Dimension dimension);

}  // namespace finray

#endif  // FINRAY_IO_UNITS_H_

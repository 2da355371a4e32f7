#include "finray/io/units.h"

#include <cmath>

namespace finray {
namespace {

constexpr double kStandardGravity = 9.80665;       // m/s^2
constexpr double kPound_kg = 0.45359237;           // exact by definition
constexpr double kFahrenheitShift = -32 * 5 / 9.;  // deg C

const std::vector<Unit>& AllUnits() {
  using D = Dimension;
  static const std::vector<Unit> units = {
      {"V", D::kVoltage},
      {"mV", D::kVoltage, 1, 1e3},
      {"uV", D::kVoltage, 1, 1e6},
      {"N", D::kForce},
      {"mN", D::kForce, 1, 1e3},
      {"kN", D::kForce, 1e3},
      {"gf", D::kForce, kStandardGravity, 1e3},
      {"kgf", D::kForce, kStandardGravity},
      {"lbf", D::kForce, kPound_kg * kStandardGravity},
      {"mm", D::kLength},
      {"um", D::kLength, 1, 1e3},
      {"cm", D::kLength, 10},
      {"m", D::kLength, 1e3},
      {"inch", D::kLength, 25.4},
      {"rad", D::kAngle},
      {"mrad", D::kAngle, 1, 1e3},
      {"deg", D::kAngle, M_PI, 180},
      {"s", D::kTime},
      {"ms", D::kTime, 1, 1e3},
      {"us", D::kTime, 1, 1e6},
      {"ns", D::kTime, 1, 1e9},
      {"degC", D::kTemperature},
      {"K", D::kTemperature, 1, 1, -273.15},
      {"degF", D::kTemperature, 5, 9, kFahrenheitShift},
  };
  return units;
}

void Replace(std::string_view from, std::string_view to, std::string* text) {
  for (auto at = text->find(from); at != std::string::npos;
       at = text->find(from, at + to.size())) {
    text->replace(at, from.size(), to);
  }
}

}  // namespace

std::optional<Unit> FindUnit(std::string_view name) {
  std::string plain(name);
  Replace("\xC2\xB5", "u", &plain);    // the micro sign
  Replace("\xCE\xBC", "u", &plain);    // the Greek letter
  Replace("\xC2\xB0", "deg", &plain);  // the degree sign
  for (const Unit& unit : AllUnits()) {
    if (unit.name == plain) return unit;
  }
  return std::nullopt;
}

Unit UnitOfColumn(const std::string& column) {
  const std::string unit = column.substr(column.rfind('_') + 1);
  return FindUnit(unit == "C" ? "degC" : unit).value_or(Unit());
}

std::vector<std::string> UnitNames(Dimension dimension) {
  std::vector<std::string> names;
  for (const Unit& unit : AllUnits()) {
    if (unit.dimension == dimension) names.push_back(unit.name);
  }
  return names;
}

}  // namespace finray

#ifndef FINRAY_IO_COLUMN_MAPPING_H_
#define FINRAY_IO_COLUMN_MAPPING_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/io/units.h"
#include "finray/io/yaml_map.h"

namespace finray {

enum class TimeFormat { kNumber, kEpoch, kIso8601 };

/// Counts of an analog-digital converter: from 0, or of two's complement.
struct AdcCounts {
  int bits;
  double from_V, to_V;
  bool is_signed;
};

/// How a column of a lab's log becomes one of the frame table:
/// value = scale * cell + offset, with the cell converted by its unit first.
struct ColumnRule {
  std::string from;  ///< The header in the log.
  std::string to;    ///< The column of the frame table.
  std::optional<double> scale;
  double offset = 0;
  std::optional<Unit> unit;
  std::optional<AdcCounts> counts;
  TimeFormat format = TimeFormat::kNumber;
};

/// How a lab writes its logs. What is left out is detected (LogLines).
struct ColumnMapping {
  std::vector<ColumnRule> rules;
  std::optional<char> delimiter;   ///< ',', ';' or '\t'.
  std::optional<char> decimal;     ///< '.' or ','.
  std::optional<int> header_line;  ///< In the file, from 1.
  std::optional<bool> units_row;   ///< Whether units stand below the header.
  /// Cells that mean not measured, beside IsNotMeasured().
  std::vector<std::string> not_measured;
  /// The file is a result that finray has written: no scene or plan says how,
  /// so errors do not tell what to state there.
  bool is_result = false;
  /// The file that the mapping was read from, if `columns:` names one.
  std::string path;

  /// Adds what `other` says and this mapping does not.
  void AddMissing(const ColumnMapping& other);
};

/// The keys that ReadColumnMapping takes from a YAML.
const std::vector<std::string>& ColumnMappingKeys();

/// Reads `columns` and the keys beside it. `columns` is a mapping, or the path
/// of a YAML with the same keys, from the folder of this one on; keys beside it
/// replace those of that file. Throws InputError.
ColumnMapping ReadColumnMapping(const YamlMap& yaml);

/// Says whether a cell stands for no measurement: it is empty or, in any case
/// of letters, NaN, NA, N/A, #N/A, #NV, null, none, missing, -, --, --- or ?.
bool IsNotMeasured(std::string_view cell);

}  // namespace finray

#endif  // FINRAY_IO_COLUMN_MAPPING_H_

#ifndef FINRAY_IO_COLUMN_MAPPING_YAML_H_
#define FINRAY_IO_COLUMN_MAPPING_YAML_H_

#include <string>

#include "finray/io/column_mapping.h"

namespace finray {

/// Returns the keys that ReadColumnMapping() reads as the same mapping, a line
/// each; "" for one that says nothing.
std::string ColumnMappingToYaml(const ColumnMapping& mapping);

}  // namespace finray

#endif  // FINRAY_IO_COLUMN_MAPPING_YAML_H_

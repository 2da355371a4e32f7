#ifndef FINRAY_IO_NEAREST_NAME_H_
#define FINRAY_IO_NEAREST_NAME_H_

#include <string>
#include <vector>

namespace finray {

/// Returns " (did you mean 'x'?)" with the candidate x nearest to `name` by
/// edit distance (case-insensitive), or "" if none is near enough.
std::string DidYouMean(const std::string& name,
                       const std::vector<std::string>& candidates);

}  // namespace finray

#endif  // FINRAY_IO_NEAREST_NAME_H_

#ifndef FINRAY_IO_NEAREST_NAME_H_
#define FINRAY_IO_NEAREST_NAME_H_

#include <string>
#include <vector>

namespace finray {

/// The candidate closest to `name` by edit distance (case-insensitive), or ""
/// if none is close enough to be what was meant.
std::string NearestName(const std::string& name,
                        const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" or "".
std::string DidYouMean(const std::string& name,
                       const std::vector<std::string>& candidates);

}  // namespace finray

#endif  // FINRAY_IO_NEAREST_NAME_H_

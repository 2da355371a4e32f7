#ifndef FINRAY_VIEW_LOG_PAGE_H_
#define FINRAY_VIEW_LOG_PAGE_H_

#include <string>
#include <vector>

#include "finray/io/warning.h"
#include "finray/view/log_channels.h"

namespace finray {

/// No page of one log is larger, whatever the number of frames.
constexpr std::size_t kMostPageBytes = 29'000'000;

/// A log of a page and what its batch warns of.
struct PageLog {
  const LogChannels* log;
  std::vector<Warning> warnings;
};

/// Returns the data of a page with one log, or two to compare, as JSON. All
/// frames are in it if they fit into `most_bytes`; else bins of 4, 8, 16, ...
/// frames, each with its least and its largest value. `finger` may be null: the
/// page then has no picture of it.
///
/// Shapes: a page interpolates those of one contact in a table (ShapeTable);
/// those of frames with two contacts are solved here, all of them up to
/// kMostPairs, else evenly spread ones.
std::string LogPageJson(const std::vector<PageLog>& logs, const Finger* finger,
                        const Discretization& discretization,
                        std::size_t most_bytes = kMostPageBytes);
constexpr std::size_t kMostPairs = 4000;

/// Returns the warnings as a JSON array of {code, text, remedy}.
std::string WarningsJson(const std::vector<Warning>& warnings);

}  // namespace finray

#endif  // FINRAY_VIEW_LOG_PAGE_H_

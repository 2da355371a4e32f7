#ifndef FINRAY_VIEW_PAGE_TEXT_H_
#define FINRAY_VIEW_PAGE_TEXT_H_

#include <string>
#include <string_view>

namespace finray {

// The build compiles the files of view/page/ into the library.
//
// Each function returns a page with nothing to load from elsewhere: page.html
// with the title as text, page.css, the body and scripts of its kind, and
// `data_json` in the element "data", where the scripts read it.

/// A log, two logs to compare, or a live log.
std::string LogPageText(std::string_view title, std::string_view data_json);
std::string BatchPageText(std::string_view title, std::string_view data_json);

}  // namespace finray

#endif  // FINRAY_VIEW_PAGE_TEXT_H_

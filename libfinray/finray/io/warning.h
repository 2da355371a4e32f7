#ifndef FINRAY_IO_WARNING_H_
#define FINRAY_IO_WARNING_H_

#include <string>

namespace finray {

/// A fact that the user should know, and what to do about it.
struct Warning {
  std::string code;
  std::string text;
  std::string remedy;
};

}  // namespace finray

#endif  // FINRAY_IO_WARNING_H_

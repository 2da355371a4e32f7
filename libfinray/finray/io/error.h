#ifndef FINRAY_IO_ERROR_H_
#define FINRAY_IO_ERROR_H_

#include <stdexcept>

namespace finray {

/// An error in the user's input. what() is one line with the place
/// (file:line:column if there is one), what was found and what was expected.
/// Executables print it and exit with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace finray

#endif  // FINRAY_IO_ERROR_H_

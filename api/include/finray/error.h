#ifndef FINRAY_ERROR_H_
#define FINRAY_ERROR_H_

#include <stdexcept>
#include <string>

#include "finray/export.h"

namespace finray::v1 {

/// The base of all exceptions of finray. what() is one line, the same as the
/// executables print.
class FINRAY_API Error : public std::runtime_error {
 public:
  Error(const std::string& what, int exit_code)
      : std::runtime_error(what), exit_code_(exit_code) {}
  ~Error() override;
  /// The exit code of an executable that meets this error.
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

/// An error in the user's input: what() has the place (file:line:column, if
/// there is one), what was found and what was expected. Exit code 2.
class FINRAY_API InputError : public Error {
 public:
  explicit InputError(const std::string& what) : Error(what, 2) {}
  ~InputError() override;
};

/// There is no solution. Exit code 3.
class FINRAY_API SolveError : public Error {
 public:
  explicit SolveError(const std::string& what) : Error(what, 3) {}
  ~SolveError() override;
};

/// There is a solution, but it would mislead: touches that leave most of an
/// object open. Exit code 4.
class FINRAY_API GateError : public Error {
 public:
  explicit GateError(const std::string& what) : Error(what, 4) {}
  ~GateError() override;
};

/// The caller asked to stop (EstimateOptions::stop and the like).
class FINRAY_API Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted", 130) {}
  ~Interrupted() override;
};

/// A fact that the user should know, and what to do about it.
struct Warning {
  std::string code;  ///< "unexplained_frames"
  std::string text;
  std::string remedy;
};

}  // namespace finray::v1

#endif  // FINRAY_ERROR_H_

#ifndef FINRAY_APPS_APP_H_
#define FINRAY_APPS_APP_H_

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/error.h"
#include "finray/io/warning.h"
#include "finray/scene/scene.h"

DECLARE_string(scheme);
DECLARE_int32(resolution);

namespace finray {

/// Exit codes of all executables.
enum ExitCode {
  kGood = 0,
  kUsage = 1,
  kBadInput = 2,
  kSolveFailed = 3,
  kGateFailed = 4,
  kInterrupted = 130,
};

/// Wrong use of a flag; main() returns kUsage for it.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the value of a flag. Throws UsageError if it is empty.
const std::string& Required(const char* flag, const std::string& value);

/// Prints "warning: text; remedy" on stderr.
void Warn(const std::string& text, const std::string& remedy);
void Warn(const std::vector<Warning>& warnings);

/// Parses the flags and leaves the other arguments. With --help or -h it prints
/// the flags of this executable, the required ones first, with --version the
/// version, and returns false.
/// Throws UsageError for an unknown flag, with the nearest name.
bool ParseFlags(int* argc, char*** argv);

/// Returns the number of threads for --threads: all cores that the process may
/// use for 0. Throws UsageError for what no machine has.
int Threads(int flag);

/// Returns true if the user gave the flag.
bool IsGiven(const char* flag);

/// Splits a comma-separated list; empty items are left out.
std::vector<std::string> SplitList(const std::string& list);

/// Returns the command with those of `flags` that differ from their defaults,
/// for result files.
std::string CommandWith(const std::vector<const char*>& flags);

/// Throws InputError if one of the outputs is a file that was read.
void RefuseToOverwrite(const std::vector<std::string>& inputs,
                       const std::vector<std::string>& outputs);

/// Prints the configuration after all files and defaults, as YAML, for
/// --dump_config.
void DumpConfig(const Finger& finger, const Scene& scene,
                const Discretization& discretization);

// Each of these stands in a source of its own with the flags that it reads or
// defines, so that an executable has the flags only if it calls the function.

/// Returns the discretization of --scheme and --resolution.
Discretization DiscretizationFlags();

/// With --dump_config, prints the configuration and returns true.
bool DumpConfigFlag(const Finger& finger, const Scene& scene,
                    const Discretization& discretization);

/// Returns the path of a file in the folder of --out_dir, which the executable
/// defines.
std::string OutPath(const std::string& name);

/// An executable. app.cc has main(), which parses flags and calls `run`. An
/// exception becomes one line on stderr and an exit code, and so does standard
/// output that cannot be written.
struct App {
  const char* usage;
  int (*run)();  ///< Returns the exit code.
  /// Where arguments go that are no flags. Without it they are an error.
  std::vector<std::string>* arguments = nullptr;
};

/// Each executable defines it.
extern const App kApp;

}  // namespace finray

#endif  // FINRAY_APPS_APP_H_

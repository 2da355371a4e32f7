#include "app.h"

#include <fcntl.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "finray/io/column_mapping_yaml.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"
#include "finray/io/versions.h"

namespace finray {
namespace {

// The error that standard output had first.
int output_error = 0;

void FlushOutput() {
  errno = 0;
  std::cout.flush();
  std::fflush(stdout);
  if (output_error == 0) output_error = errno;
}

}  // namespace

const std::string& Required(const char* flag, const std::string& value) {
  if (value.empty()) throw UsageError(std::string("--") + flag + " is missing");
  return value;
}

void Warn(const std::string& text, const std::string& remedy) {
  FlushOutput();
  // One piece, which lines of other threads cannot part.
  std::cerr << OneLine("warning: " + text + "; " + remedy) + "\n";
}

void Warn(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) Warn(warning.text, warning.remedy);
}

bool IsGiven(const char* flag) {
  return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default;
}

std::vector<std::string> SplitList(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');) {
    if (!item.empty()) items.push_back(item);
  }
  return items;
}

std::string CommandWith(const std::vector<const char*>& flags) {
  std::string command = gflags::ProgramInvocationShortName();
  for (const char* flag : flags) {
    const auto info = gflags::GetCommandLineFlagInfoOrDie(flag);
    if (info.current_value == info.default_value) continue;
    command += " --" + info.name;
    if (info.type == "double") {
      command += " " + NumberText(*static_cast<const double*>(info.flag_ptr));
    } else if (info.type != "bool") {
      command += " " + info.current_value;
    } else if (info.current_value == "false") {
      command += "=false";
    }
  }
  return command;
}

void DumpConfig(const Finger& finger, const Scene& scene,
                const Discretization& discretization) {
  std::cout << "scheme: " << SchemeName(discretization.scheme) << "\n"
            << "resolution: " << EffectiveResolution(discretization) << "\n"
            << "contacts: "
            << (scene.contacts ? std::to_string(*scene.contacts) : "auto")
            << "\n";
  if (!scene.contacts) {
    std::cout << "most_contacts: " << scene.most_contacts << "\n";
  }
  if (!scene.contact_beams.empty()) {
    std::cout << "contact_beams: " << ContactBeamsToYaml(scene) << "\n";
  }
  std::cout << "friction_coefficient: " << scene.friction_coefficient << "\n";
  if (scene.friction_std > 0) {
    std::cout << "friction_std: " << scene.friction_std << "\n";
  }
  if (scene.presliding_mm) {
    std::cout << "presliding_mm: " << *scene.presliding_mm << "\n";
  }
  if (scene.force_max_N) {
    std::cout << "force_max_N: " << *scene.force_max_N << "\n";
  }
  if (scene.search_iteration_limit) {
    std::cout << "search_iteration_limit: " << *scene.search_iteration_limit
              << "\n";
  }
  if (scene.object) {
    std::cout << "object: " << ObjectToYaml(*scene.object) << "\n";
  }
  if (scene.object_std_mm) {
    std::cout << "measurements: {object_std_mm: " << *scene.object_std_mm
              << "}\n";
  }
  if (scene.smoothing) {
    std::cout << "smoothing: {contact_std_mm: " << scene.smoothing->contact_mm
              << ", normal_std_N: " << scene.smoothing->normal_N << "}\n";
  }
  if (scene.gauge_offset_walk) {
    std::cout << "gauge_offset_walk: {start_std_V: "
              << scene.gauge_offset_walk->start_std_V << ", std_V_per_sqrt_s: "
              << scene.gauge_offset_walk->std_V_per_sqrt_s << "}\n";
  }
  std::cout << ColumnMappingToYaml(scene.columns);
  std::istringstream lines(FingerToYaml(finger));
  std::cout << "finger:\n";
  for (std::string line; std::getline(lines, line);) {
    std::cout << "  " << line << "\n";
  }
}

void RefuseToOverwrite(const std::vector<std::string>& inputs,
                       const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    for (const std::string& input : inputs) {
      std::error_code missing;
      if (std::filesystem::equivalent(input, output, missing)) {
        throw InputError(input +
                         ": is an input and would be written over; "
                         "choose another output");
      }
    }
  }
}

}  // namespace finray

namespace {

using namespace finray;

// A file that is opened while a standard stream is closed takes its number, and
// what is printed then goes into that file. The stand-ins cannot be read or
// written either.
void ReserveStandardStreams() {
  for (int file = 0; file <= 2; ++file) {
    if (fcntl(file, F_GETFD) >= 0) continue;
    if (open("/dev/null", file == 0 ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

ExitCode Fail(const std::string& message, ExitCode code) {
  std::cerr << OneLine(gflags::ProgramInvocationShortName() +
                       (": " + message)) +
                   "\n";
  return code;
}

int RunApp(int argc, char** argv) {
  try {
    if (!ParseFlags(&argc, &argv)) return kGood;
    if (kApp.arguments != nullptr) {
      kApp.arguments->assign(argv + 1, argv + argc);
    } else if (argc > 1) {
      throw UsageError(std::string("'") + argv[1] +
                       "' is not a flag; flags start with --");
    }
    return kApp.run();
  } catch (const UsageError& error) {
    return Fail(std::string(error.what()) + "; see --help", kUsage);
  } catch (const InputError& error) {
    return Fail(error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return Fail("the memory does not suffice for this input", kBadInput);
  } catch (const std::length_error&) {  // a container beyond all memory
    return Fail("the memory does not suffice for this input", kBadInput);
  } catch (const std::system_error& error) {  // files, threads
    return Fail(error.what(), kBadInput);
  } catch (const std::exception& error) {
    return Fail(error.what(), kSolveFailed);
  }
}

// Returns the exit code of a run that ends with `code`: output that is lost is
// an error.
int WithOutput(int code) {
  FlushOutput();
  if (std::cout && std::ferror(stdout) == 0) return code;
  Fail(std::string("standard output: cannot be written: ") +
           std::strerror(output_error),
       kBadInput);
  return code == kGood ? kBadInput : code;
}

}  // namespace

int main(int argc, char** argv) {
  ReserveStandardStreams();
  std::signal(SIGPIPE, SIG_IGN);  // it is an error of writing
  gflags::SetUsageMessage(kApp.usage);
  gflags::SetVersionString(FINRAY_VERSION "\n" + std::string(kVersions));
  FLAGS_logtostderr = true;
  // Solvers try steps that fail. Users read what the tools say instead.
  FLAGS_minloglevel = google::GLOG_FATAL;
  google::InitGoogleLogging(argv[0]);
  return WithOutput(RunApp(argc, argv));
}

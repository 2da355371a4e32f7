// Flags as all executables print and check them, in place of gflags' own help:
// that lists glog's flags too, and ends with exit code 1.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <iterator>

#include "app.h"
#include "finray/io/message_text.h"
#include "finray/io/usable_cores.h"

namespace finray {
namespace {

// The flags of this executable in a source of apps/, sorted by name.
std::vector<gflags::CommandLineFlagInfo> OwnFlags() {
  std::vector<gflags::CommandLineFlagInfo> all, own;
  gflags::GetAllFlags(&all);
  std::copy_if(all.begin(), all.end(), std::back_inserter(own),
               [](const auto& flag) {
                 return flag.filename.find("apps/") != std::string::npos;
               });
  std::sort(own.begin(), own.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return own;
}

// A flag is required if the example of the usage names it before any bracket.
bool IsRequired(const std::string& name) {
  const std::string usage = kApp.usage;
  const std::size_t example = usage.find('\n');
  const std::size_t at = usage.find(" --" + name + " ", example);
  return at != std::string::npos && at < usage.find('[', example) &&
         at < usage.find('\n', example + 1);
}

void PrintFlags(const std::vector<gflags::CommandLineFlagInfo>& flags,
                bool required) {
  for (const auto& flag : flags) {
    if (IsRequired(flag.name) != required) continue;
    std::printf("  --%-26s %s", flag.name.c_str(), flag.description.c_str());
    if (!required && !flag.default_value.empty()) {
      std::printf(" (default: %s)", flag.default_value.c_str());
    }
    std::printf("\n");
  }
}

void PrintHelp() {
  const auto flags = OwnFlags();
  const std::string usage = kApp.usage;
  const std::size_t end = usage.find('\n');
  std::printf("%s\n\n  %s\n", usage.substr(0, end).c_str(),
              usage.substr(end + 1).c_str());
  if (std::any_of(flags.begin(), flags.end(),
                  [](const auto& flag) { return IsRequired(flag.name); })) {
    std::printf("\nRequired\n");
    PrintFlags(flags, true);
  }
  std::printf("\nOptional\n");
  PrintFlags(flags, false);
  std::printf("  --%-26s %s\n", "version", "print the version and stop");
  std::printf(
      "\nExit code: 0 good, 1 wrong usage, 2 bad input, 3 no solution, "
      "4 a check failed.\n");
}

// Returns what a flag of this type takes, in words.
const char* Expected(const std::string& type) {
  if (type == "bool") return "true or false";
  if (type == "double") return "a number";
  return type[0] == 'u' ? "a whole number, 0 or more" : "a whole number";
}

// Throws UsageError if a flag does not take the value.
void RefuseWrongKind(const gflags::CommandLineFlagInfo& flag,
                     const std::string& value) {
  // gflags' own flags of text may do something; text is never of a wrong kind.
  if (flag.type == "string") return;
  if (!gflags::SetCommandLineOption(flag.name.c_str(), value.c_str()).empty()) {
    return;
  }
  const bool large =
      !value.empty() && value.find_first_not_of("+-0123456789") == value.npos;
  throw UsageError("--" + flag.name + ": expected " + Expected(flag.type) +
                   (large ? " of fewer digits" : "") + ", found '" + value +
                   "'");
}

// Throws UsageError if a flag is unknown, with the nearest name, or has no
// value, or one of another kind.
void RefuseWrongFlags(int argc, char** argv) {
  for (int i = 1; i < argc && std::strcmp(argv[i], "--") != 0; ++i) {
    const std::string argument = argv[i];
    if (argument.size() < 2 || argument[0] != '-') continue;
    const std::size_t first = argument.find_first_not_of('-');
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(first, equals - first);
    gflags::CommandLineFlagInfo info;
    if (gflags::GetCommandLineFlagInfo(name.c_str(), &info)) {
      if (equals != std::string::npos) {
        RefuseWrongKind(info, argument.substr(equals + 1));
      } else if (info.type != "bool") {
        // The next argument is the value of this flag.
        if (++i == argc) throw UsageError("--" + name + " needs a value");
        RefuseWrongKind(info, argv[i]);
      }
      continue;
    }
    if (name.find("no") == 0 &&
        gflags::GetCommandLineFlagInfo(name.substr(2).c_str(), &info)) {
      continue;
    }
    std::vector<std::string> names;
    for (const auto& flag : OwnFlags()) names.push_back(flag.name);
    throw UsageError("--" + name + " is not a flag" + DidYouMean(name, names));
  }
}

}  // namespace

int Threads(int flag) {
  try {
    return ThreadsFor("--threads", flag);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}

bool ParseFlags(int* argc, char*** argv) {
  gflags::SetArgv(*argc, const_cast<const char**>(*argv));
  const auto given = [&](std::initializer_list<const char*> names) {
    return std::any_of(*argv + 1, *argv + *argc, [&](const char* argument) {
      return std::any_of(names.begin(), names.end(), [&](const char* name) {
        return std::strcmp(argument, name) == 0;
      });
    });
  };
  if (given({"-h", "-help", "--help"})) {
    PrintHelp();
    return false;
  }
  if (given({"-version", "--version"})) {  // gflags' own ends the process
    std::printf("%s version %s\n", gflags::ProgramInvocationShortName(),
                gflags::VersionString());
    return false;
  }
  RefuseWrongFlags(*argc, *argv);
  gflags::ParseCommandLineFlags(argc, argv, true);
  // At once, not when they are needed, which may be minutes later.
  gflags::CommandLineFlagInfo threads;
  if (gflags::GetCommandLineFlagInfo("threads", &threads)) {
    Threads(*static_cast<const int*>(threads.flag_ptr));
  }
  return true;
}

}  // namespace finray

#ifndef FINRAY_TESTS_FUZZ_FEEDING_H_
#define FINRAY_TESTS_FUZZ_FEEDING_H_

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "finray/io/error.h"
#include "fuzz/targets.h"
#include "test_finger.h"

namespace finray {

/// A file in memory, which has a path as long as it lives.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes)
      : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t n = write(file_, bytes.data() + done, bytes.size() - done);
      if (n <= 0) std::abort();
      done += static_cast<std::size_t>(n);
    }
    lseek(file_, 0, SEEK_SET);
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }
  int descriptor() const { return file_; }

 private:
  int file_;
};

/// Runs; a line that says what is wrong with the input is as good.
template <typename Read>
void Tolerate(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const std::string_view text = error.what();
    const bool one_line =
        !text.empty() && text.find_first_of(std::string_view("\0\n\r", 3)) ==
                             std::string_view::npos;
    if (!one_line || text.size() > 6000) {
      std::fprintf(stderr, "a message is no short line: %s\n", error.what());
      std::abort();
    }
  }
}

/// Ends the process unless `good`.
inline void Check(bool good, const char* what) {
  if (good) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

/// Up to kNextFile, which goes too.
inline std::string_view TakeFile(std::string_view* bytes) {
  const auto end = bytes->find(kNextFile);
  const std::string_view file = bytes->substr(0, end);
  bytes->remove_prefix(end == std::string_view::npos ? bytes->size()
                                                     : end + kNextFile.size());
  return file;
}

/// The finger that inputs are for.
inline const Finger& Paper() {
  static const Finger finger = PaperFinger();
  return finger;
}

}  // namespace finray

#endif  // FINRAY_TESTS_FUZZ_FEEDING_H_

#ifndef FINRAY_IO_RESUMABLE_FILE_H_
#define FINRAY_IO_RESUMABLE_FILE_H_

#include <cstdint>
#include <future>
#include <string>

#include "finray/io/file_descriptor.h"

namespace finray {

/// A file written piece by piece over a time in which anything may end the
/// process or the machine. It grows as `.<name>.part`; `.<name>.journal` holds
/// the key it belongs to and its checkpoints. The file appears under its own
/// name only when it is complete.
///
/// Order of what reaches the disk: the bytes, then the checkpoint that counts
/// them; the last checkpoint, then the rename, then the journal's removal. So
/// a journal never counts bytes that are not there.
///
/// All functions throw InputError naming the file if it cannot be written, or
/// if another process is writing it.
class ResumableFile {
 public:
  /// Whether a run is writing this file or was interrupted while it did.
  static bool IsUnderWay(const std::string& path);

  /// With `resume`, goes on behind the last checkpoint of an interrupted file
  /// of the same key (text on one line); otherwise starts over.
  ResumableFile(const std::string& path, const std::string& key, bool resume);

  /// What the checkpoint it went on from was noted with; "" if it started over.
  const std::string& note() const { return note_; }
  /// Whether it is complete and under its own name already, only Forget() being
  /// left to do.
  bool finished() const { return finished_; }
  std::uint64_t bytes() const { return bytes_; }

  void Append(const std::string& text);
  /// Makes all that was appended safe, with a note on one line.
  void Checkpoint(const std::string& note);
  /// The same without waiting for the disk: more can be appended meanwhile.
  /// Does nothing while the disk is still busy with the one before.
  void CheckpointSoon(const std::string& note);
  /// A last checkpoint; then gives the file its own name.
  void Finish(const std::string& note);
  /// Removes the journal: from now on the file looks after itself.
  void Forget();
  /// Removes what was written, for an input that turned out to be bad.
  void Discard();

 private:
  void Lock();
  bool Restore(const std::string& key);
  void StartOver(const std::string& key);
  // Bytes and line to the disk, in this order; an errno value if that fails.
  int Save(const std::string& line);
  // Waits for the checkpoint under way.
  void Settle();
  // Throws unless `error` is 0.
  void Check(int error) const;

  std::string path_, folder_, part_path_, journal_path_;
  FileDescriptor part_, journal_;
  std::string note_;
  std::uint64_t bytes_ = 0;
  bool finished_ = false;
  std::future<int> saving_;  // last: its end comes before that of the files
};

}  // namespace finray

#endif  // FINRAY_IO_RESUMABLE_FILE_H_

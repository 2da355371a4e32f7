#ifndef FINRAY_IO_RESUMABLE_FILE_H_
#define FINRAY_IO_RESUMABLE_FILE_H_

#include <cstdint>
#include <future>
#include <string>

#include "finray/io/atomic_file.h"

namespace finray {

/// A file that is written piece by piece and survives the end of the process or
/// of the machine at any time. It grows as `.<name>.part`; `.<name>.journal`
/// holds its key and its checkpoints. The file gets its own name when it is
/// complete.
///
/// The bytes reach the disk before the checkpoint that counts them; the last
/// checkpoint before the rename; the rename before the journal is removed. So a
/// journal never counts bytes that are not there.
///
/// All functions throw InputError with the file's name if it cannot be written
/// or if another process is writing it.
class ResumableFile {
 public:
  /// Says whether a run is writing this file or was interrupted while it wrote
  /// it.
  static bool IsUnderWay(const std::string& path);

  /// With `resume`, goes on behind the last checkpoint of an interrupted file
  /// that has the same key (one line of text). Otherwise, or if there is none,
  /// starts over.
  ResumableFile(const std::string& path, const std::string& key, bool resume);

  /// The note of the checkpoint where it went on; "" if it started over.
  const std::string& note() const { return note_; }
  /// Says whether the file is complete under its own name. Only Forget() is
  /// then left to do.
  bool finished() const { return finished_; }
  std::uint64_t bytes() const { return bytes_; }

  void Append(const std::string& text);
  /// Makes a checkpoint with a note of one line. Returns once all appended
  /// bytes are on the disk.
  void Checkpoint(const std::string& note);
  /// Makes a checkpoint without waiting for the disk. Does nothing while the
  /// checkpoint before it is still being written.
  void CheckpointSoon(const std::string& note);
  /// Makes the last checkpoint and gives the file its own name.
  void Finish(const std::string& note);
  /// Removes the journal.
  void Forget();
  /// Removes the partial file and the journal.
  void Discard();

 private:
  void Lock();
  bool Restore(const std::string& key);
  void StartOver(const std::string& key);
  // Brings the bytes and then the line to the disk. Returns 0 or an errno
  // value.
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
  std::future<int> saving_;  // last member, so that it ends before the files
};

}  // namespace finray

#endif  // FINRAY_IO_RESUMABLE_FILE_H_

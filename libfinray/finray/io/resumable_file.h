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
/// journal never counts bytes that are not there. Each checkpoint holds
/// checksums (CRC-32) of these bytes and of the journal so far, so that a file
/// that was damaged meanwhile is not gone on with.
///
/// Links that stand in the place of its files are not followed: one at `path`
/// is replaced, and those of the other two are errors.
///
/// All functions throw InputError with the file's name if it cannot be written
/// or if another process is writing it.
class ResumableFile {
 public:
  /// Says whether a run is writing this file or was interrupted while it wrote
  /// it.
  static bool IsUnderWay(const std::string& path);

  /// With `resume`, goes on behind the last checkpoint of an interrupted file
  /// that has the same key (one line of text) and checksums that hold.
  /// Otherwise, or if there is none, starts over.
  ResumableFile(const std::string& path, const std::string& key, bool resume);

  /// The note of the checkpoint where it went on; "" if it started over.
  const std::string& note() const { return note_; }
  /// Says whether the file is complete under its own name. Only Forget() is
  /// then left to do.
  bool finished() const { return finished_; }
  std::uint64_t bytes() const { return bytes_; }
  /// The partial file or the journal if its checksum or form was wrong, which
  /// has put the file back or started it over; "" otherwise.
  const std::string& damaged() const { return damaged_; }

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
  // Returns a line of the journal at the present bytes, which its checksum then
  // counts.
  std::string NextLine(const char* kind, const std::string& note);
  // Brings the bytes and then the line to the disk. Returns 0 or an errno
  // value.
  int Save(const std::string& line);
  // Waits for the checkpoint under way.
  void Settle();
  // Throws unless `error` is 0.
  void Check(int error) const;
  // Opens one of the two files beside it. Throws for a link.
  void OpenHidden(const std::string& path, int flags,
                  FileDescriptor* file) const;

  std::string path_, folder_, part_path_, journal_path_;
  FileDescriptor part_, journal_;
  std::string note_, damaged_;
  std::uint64_t bytes_ = 0;
  // Checksums of the bytes and of the journal.
  std::uint32_t part_sum_ = 0, journal_sum_ = 0;
  bool finished_ = false;
  std::future<int> saving_;  // last member, so that it ends before the files
};

}  // namespace finray

#endif  // FINRAY_IO_RESUMABLE_FILE_H_

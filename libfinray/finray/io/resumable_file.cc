#include "finray/io/resumable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "finray/io/error.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

// The lines of a journal are "checkpoint <bytes> <note> end", the last one
// "finished <bytes> <note> end". A line that was cut short does not match.
constexpr char kEnd[] = " end";
constexpr char kJournal[] = ".journal";
constexpr int kLongestJournal_MiB = 1024;

// Returns the file behind a link.
fs::path Target(const std::string& path) {
  std::error_code missing;
  const fs::path target = fs::canonical(path, missing);
  return missing ? fs::path(path) : target;
}

std::string Hidden(const fs::path& target, const char* ending) {
  const std::string name = "." + target.filename().string() + ending;
  return (target.parent_path() / name).string();
}

std::string Header(const std::string& key) {
  return "finray journal 1 " + key + "\n";
}

std::string JournalLine(const char* kind, std::uint64_t bytes,
                        const std::string& note) {
  return std::string(kind) + " " + std::to_string(bytes) + " " + note + kEnd +
         "\n";
}

}  // namespace

bool ResumableFile::IsUnderWay(const std::string& path) {
  std::error_code unknown;
  return fs::exists(Hidden(Target(path), kJournal), unknown);
}

ResumableFile::ResumableFile(const std::string& path, const std::string& key,
                             bool resume)
    : path_(Target(path).string()),
      folder_(Target(path).parent_path().string()),
      part_path_(Hidden(path_, ".part")),
      journal_path_(Hidden(path_, kJournal)) {
  std::error_code unknown;
  if (fs::exists(path_, unknown) && !fs::is_regular_file(path_, unknown)) {
    throw InputError(path + ": cannot be written: it is no regular file");
  }
  Check(journal_.Open(journal_path_, O_RDWR | O_CREAT));
  Lock();
  if (!resume || !Restore(key)) StartOver(key);
}

void ResumableFile::Lock() {
  const bool locked = flock(journal_.get(), LOCK_EX | LOCK_NB) == 0;
  // A file system without locks is used without them.
  bool busy = !locked && errno == EWOULDBLOCK;
  struct stat journal;
  // A run that has just ended may have removed the journal.
  if (!busy)
    busy = fstat(journal_.get(), &journal) == 0 && journal.st_nlink == 0;
  if (busy) throw InputError(path_ + ": another process is writing it");
}

bool ResumableFile::Restore(const std::string& key) {
  const std::string journal =
      ReadWholeFile(journal_path_, "a journal", kLongestJournal_MiB);
  if (journal.rfind(Header(key), 0) != 0) return false;
  std::size_t at = Header(key).size();
  bool any = false, finished = false;
  std::uint64_t bytes = 0;
  std::string note;
  for (std::size_t end; (end = journal.find('\n', at)) != std::string::npos;
       at = end + 1) {
    std::istringstream line(journal.substr(at, end - at));
    std::string kind, rest;
    std::uint64_t covered;
    if (!(line >> kind >> covered && line.get() == ' ')) break;
    if (kind != "checkpoint" && kind != "finished") break;
    std::getline(line, rest);
    const std::size_t length = rest.size() - std::strlen(kEnd);
    if (rest.size() < std::strlen(kEnd) || rest.substr(length) != kEnd) break;
    any = true;
    finished = kind == "finished";
    bytes = covered;
    note = rest.substr(0, length);
  }
  if (!any) return false;
  std::error_code unknown;
  const bool part = fs::exists(part_path_, unknown);
  if (part) {
    if (fs::file_size(part_path_, unknown) < bytes || unknown) return false;
    Check(part_.Open(part_path_, O_RDWR));
    Check(part_.Truncate(bytes));
  } else if (!finished || !fs::exists(path_, unknown) ||
             fs::file_size(path_, unknown) != bytes) {
    return false;
  }
  Check(journal_.Truncate(at));
  bytes_ = bytes;
  note_ = note;
  finished_ = !part;
  return true;
}

void ResumableFile::StartOver(const std::string& key) {
  // The old checkpoints must be gone before the bytes that they count.
  Check(journal_.Truncate(0));
  Check(journal_.Write(Header(key)));
  Check(journal_.Sync());
  Check(part_.Open(part_path_, O_RDWR | O_CREAT | O_TRUNC));
  SyncFolder(folder_);  // for both new files; some file systems cannot do it
}

int ResumableFile::Save(const std::string& line) {
  int error = part_.Sync();
  if (error == 0) error = journal_.Write(line);
  return error != 0 ? error : journal_.Sync();
}

void ResumableFile::Settle() {
  if (saving_.valid()) Check(saving_.get());
}

void ResumableFile::Append(const std::string& text) {
  Check(part_.Write(text));
  bytes_ += text.size();
}

void ResumableFile::Checkpoint(const std::string& note) {
  Settle();
  Check(Save(JournalLine("checkpoint", bytes_, note)));
}

void ResumableFile::CheckpointSoon(const std::string& note) {
  if (saving_.valid() &&
      saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  Settle();
  saving_ = std::async(std::launch::async, &ResumableFile::Save, this,
                       JournalLine("checkpoint", bytes_, note));
}

void ResumableFile::Finish(const std::string& note) {
  Settle();
  Check(Save(JournalLine("finished", bytes_, note)));
  Check(part_.Close());
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0) Check(errno);
  SyncFolder(folder_);
  finished_ = true;
}

void ResumableFile::Forget() { unlink(journal_path_.c_str()); }

void ResumableFile::Discard() {
  if (saving_.valid()) saving_.wait();
  unlink(part_path_.c_str());
  unlink(journal_path_.c_str());
}

void ResumableFile::Check(int error) const {
  if (error != 0) {
    throw InputError(path_ + ": cannot be written: " + std::strerror(error));
  }
}

}  // namespace finray

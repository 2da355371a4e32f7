#include "finray/io/resumable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "finray/io/error.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

// The lines of a journal are "checkpoint <bytes> <sum> <note> end <sum>", the
// last one "finished ...". The first sum is that of the bytes, the other one
// that of the journal up to it. A line that was cut short does not match.
constexpr char kEnd[] = " end ";
constexpr char kJournal[] = ".journal";
constexpr int kLongestJournal_MiB = 1024;
constexpr int kSumDigits = 8;

std::string Hidden(const fs::path& path, const char* ending) {
  const std::string name = "." + path.filename().string() + ending;
  return (path.parent_path() / name).string();
}

std::uint32_t Sum(std::uint32_t sum, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string SumText(std::uint32_t sum) {
  return FormatText("%0*x", kSumDigits, static_cast<unsigned>(sum));
}

std::string Header(const std::string& key) {
  const std::string header = "finray journal 2 " + key + " ";
  return header + SumText(Sum(0, header)) + "\n";
}

struct JournalLine {
  bool finished;
  std::uint64_t bytes;
  std::string sum;  // of the bytes
  std::string note;
};

// Reads a line with its end. `before` is the sum of all lines before it.
std::optional<JournalLine> ReadLine(std::string_view line,
                                    std::uint32_t before) {
  const std::size_t own = kSumDigits + 1;
  if (line.size() < own) return std::nullopt;
  const std::string_view summed = line.substr(0, line.size() - own);
  if (line.substr(summed.size(), kSumDigits) != SumText(Sum(before, summed))) {
    return std::nullopt;
  }
  std::istringstream words{std::string(summed)};
  JournalLine read;
  std::string kind;
  if (!(words >> kind >> read.bytes >> read.sum && words.get() == ' ')) {
    return std::nullopt;
  }
  read.finished = kind == "finished";
  std::getline(words, read.note);
  read.note.resize(read.note.size() -
                   std::min(read.note.size(), std::strlen(kEnd)));
  return read;
}

// Returns the sums of the first bytes of a file, at each of the `counts`, which
// grow.
std::vector<std::string> SumsOf(const FileDescriptor& file,
                                const std::vector<std::uint64_t>& counts) {
  std::vector<std::string> sums;
  std::vector<char> buffer(1 << 18);
  std::uint32_t sum = 0;
  std::uint64_t at = 0;
  for (const std::uint64_t count : counts) {
    while (at < count) {
      const ssize_t read =
          pread(file.get(), buffer.data(),
                std::min<std::uint64_t>(buffer.size(), count - at),
                static_cast<off_t>(at));
      if (read <= 0) return sums;
      const auto size = static_cast<std::size_t>(read);
      sum = Sum(sum, {buffer.data(), size});
      at += size;
    }
    sums.push_back(SumText(sum));
  }
  return sums;
}

}  // namespace

bool ResumableFile::IsUnderWay(const std::string& path) {
  std::error_code unknown;
  return fs::exists(Hidden(path, kJournal), unknown);
}

ResumableFile::ResumableFile(const std::string& path, const std::string& key,
                             bool resume)
    : path_(path),
      folder_(fs::path(path).parent_path().string()),
      part_path_(Hidden(path_, ".part")),
      journal_path_(Hidden(path_, kJournal)) {
  std::error_code unknown;
  if (fs::exists(path_, unknown) && !fs::is_regular_file(path_, unknown)) {
    throw InputError(path + ": cannot be written: it is no regular file");
  }
  OpenHidden(journal_path_, O_RDWR | O_CREAT, &journal_);
  Lock();
  if (!resume || !Restore(key)) StartOver(key);
}

void ResumableFile::OpenHidden(const std::string& path, int flags,
                               FileDescriptor* file) const {
  const int error = file->Open(path, flags | O_NOFOLLOW);
  if (error == ELOOP) {
    throw InputError(path_ + ": cannot be written: " + path +
                     " is a link, expected a file of finray's or none");
  }
  Check(error);
  struct stat opened;
  if (fstat(file->get(), &opened) != 0 || !S_ISREG(opened.st_mode)) {
    throw InputError(path + ": is no regular file");
  }
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
  const std::string header = Header(key);
  if (journal.rfind(header, 0) != 0) {
    // Another key is no damage, but then its own sum holds.
    const std::size_t end = std::min(journal.find('\n'), journal.size());
    const std::string_view line(journal.data(), end);
    const std::size_t own =
        line.size() - std::min<std::size_t>(line.size(), kSumDigits);
    if (line.rfind("finray journal 1 ", 0) != 0 && !journal.empty() &&
        line.substr(own) != SumText(Sum(0, line.substr(0, own)))) {
      damaged_ = journal_path_;
    }
    return false;
  }
  std::vector<JournalLine> lines;
  std::vector<std::uint64_t> counts;
  std::vector<std::size_t> ends;  // of the lines in the journal
  std::size_t at = header.size();
  std::uint32_t sum = Sum(0, header);
  std::vector<std::uint32_t> sums;  // of the journal up to these ends
  for (std::size_t end; (end = journal.find('\n', at)) != std::string::npos;) {
    const std::string_view text(journal.data() + at, end + 1 - at);
    const auto line = ReadLine(text, sum);
    if (!line || (!counts.empty() && line->bytes < counts.back())) break;
    sum = Sum(sum, text);
    at = end + 1;
    lines.push_back(*line);
    counts.push_back(line->bytes);
    ends.push_back(at);
    sums.push_back(sum);
  }
  if (at != journal.size()) damaged_ = journal_path_;
  if (lines.empty()) return false;
  std::error_code unknown;
  const bool has_part = fs::exists(fs::symlink_status(part_path_, unknown));
  FileDescriptor whole;
  if (has_part) {
    OpenHidden(part_path_, O_RDWR, &part_);
  } else if (!lines.back().finished || whole.Open(path_, O_RDONLY) != 0) {
    return false;
  }
  const std::vector<std::string> found =
      SumsOf(has_part ? part_ : whole, counts);
  std::size_t good = 0;
  while (good < found.size() && found[good] == lines[good].sum) ++good;
  if (good < lines.size()) damaged_ = has_part ? part_path_ : path_;
  if (good == 0 ||
      (!has_part && (good < lines.size() ||
                     fs::file_size(path_, unknown) != counts.back()))) {
    return false;
  }
  const JournalLine& last = lines[good - 1];
  if (has_part) Check(part_.Truncate(last.bytes));
  Check(journal_.Truncate(ends[good - 1]));
  bytes_ = last.bytes;
  note_ = last.note;
  part_sum_ = static_cast<std::uint32_t>(std::stoul(last.sum, nullptr, 16));
  journal_sum_ = sums[good - 1];
  finished_ = !has_part;
  return true;
}

void ResumableFile::StartOver(const std::string& key) {
  // The old checkpoints must be gone before the bytes that they count.
  const std::string header = Header(key);
  journal_sum_ = Sum(0, header);
  Check(journal_.Truncate(0));
  Check(journal_.Write(header));
  Check(journal_.Sync());
  unlink(part_path_.c_str());
  OpenHidden(part_path_, O_RDWR | O_CREAT | O_EXCL, &part_);
  SyncFolder(folder_);  // for both new files; some file systems cannot do it
}

std::string ResumableFile::NextLine(const char* kind, const std::string& note) {
  std::string line = std::string(kind) + " " + std::to_string(bytes_) + " " +
                     SumText(part_sum_) + " " + note + kEnd;
  line += SumText(Sum(journal_sum_, line)) + "\n";
  journal_sum_ = Sum(journal_sum_, line);
  return line;
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
  part_sum_ = Sum(part_sum_, text);
}

void ResumableFile::Checkpoint(const std::string& note) {
  Settle();
  Check(Save(NextLine("checkpoint", note)));
}

void ResumableFile::CheckpointSoon(const std::string& note) {
  if (saving_.valid() &&
      saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  Settle();
  saving_ = std::async(std::launch::async, &ResumableFile::Save, this,
                       NextLine("checkpoint", note));
}

void ResumableFile::Finish(const std::string& note) {
  Settle();
  Check(Save(NextLine("finished", note)));
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

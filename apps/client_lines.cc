#include "client_lines.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "finray/io/error.h"

namespace finray {
namespace {

// A socket that can be written to has room for so much.
constexpr std::size_t kPiece_bytes = 16384;
constexpr short kBroken = POLLERR | POLLHUP | POLLNVAL;

}  // namespace

void ClientLines::Queue::Drop(std::size_t count) {
  begin_ += count;
  if (2 * begin_ < bytes_.size()) return;
  bytes_.erase(0, begin_);
  begin_ = 0;
}

ClientLines::ClientLines(int file, int stop_file, const std::string& name)
    : file_(file),
      stop_file_(stop_file),
      name_(name),
      leave_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (leave_ < 0) throw InputError(name + ": " + std::strerror(errno));
}

ClientLines::~ClientLines() { close(leave_); }

void ClientLines::Leave() {
  left_ = true;
  const std::uint64_t one = 1;
  // Fails only where it has been written before.
  [[maybe_unused]] const ssize_t count = write(leave_, &one, sizeof one);
}

int ClientLines::Wait(short events, int most_ms) const {
  pollfd waiting[3] = {
      {file_, events, 0}, {stop_file_, POLLIN, 0}, {leave_, POLLIN, 0}};
  int count;
  while ((count = poll(waiting, 3, most_ms)) < 0 && errno == EINTR) {
    if (left_) return -1;
  }
  if (count < 0 || waiting[1].revents != 0 || waiting[2].revents != 0) {
    return -1;
  }
  return waiting[0].revents;
}

void ClientLines::Send() {
  while (rows_.size() > 0 && !gone_) {
    pollfd waiting = {file_, POLLOUT, 0};
    if (poll(&waiting, 1, 0) <= 0) return;
    const std::string_view rows = rows_.view();
    std::size_t piece = rows.size();
    if (piece > kPiece_bytes) {
      const std::size_t fits = rows.rfind('\n', kPiece_bytes - 1);
      piece = (fits == rows.npos ? rows.find('\n') : fits) + 1;
    }
    const ssize_t count =
        send(file_, rows.data(), piece, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count >= 0) {
      rows_.Drop(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      gone_ = true;
      rows_.Clear();
    }
  }
}

std::size_t ClientLines::Receive(char* buffer, std::size_t size) {
  const ssize_t count = recv(file_, buffer, size, MSG_DONTWAIT);
  if (count > 0) return static_cast<std::size_t>(count);
  error_ = count == 0 ? 0 : errno;
  ended_ = error_ != EAGAIN && error_ != EINTR;
  return 0;
}

int ClientLines::Read(char* buffer, int size) {
  const auto most = static_cast<std::size_t>(size);
  if (sent_.size() > 0) {
    const std::size_t count = sent_.view().copy(buffer, most);
    sent_.Drop(count);
    return static_cast<int>(count);
  }
  while (!ended_) {
    const int found = Wait(rows_.size() > 0 ? POLLIN | POLLOUT : POLLIN, -1);
    if (found < 0) return -1;
    if ((found & POLLOUT) != 0) Send();
    if ((found & (POLLIN | kBroken)) == 0) continue;
    if (const std::size_t count = Receive(buffer, most); count > 0) {
      return static_cast<int>(count);
    }
  }
  if (error_ == 0) return 0;
  throw InputError(name_ + ": cannot be read: " + std::strerror(error_));
}

bool ClientLines::Write(std::string_view line) {
  rows_.Add(line);
  Send();
  while (rows_.size() > kMostRows_bytes) {
    const bool full = ended_ || sent_.size() >= kMostSent_bytes;
    const int found = Wait(full ? POLLOUT : POLLIN | POLLOUT,
                           full && !ended_ ? 1000 * kPatience_s : -1);
    if (found < 0) return false;
    if (found == 0) {
      throw InputError(name_ + ": " + std::to_string(kMostRows_bytes >> 20) +
                       " MiB of rows and " +
                       std::to_string(kMostSent_bytes >> 20) +
                       " MiB of lines wait, as it writes and does not read; "
                       "expected a client that reads while it writes");
    }
    if ((found & (POLLOUT | kBroken)) != 0) Send();
    if (!full && (found & POLLIN) != 0) {
      char bytes[1 << 16];
      sent_.Add({bytes, Receive(bytes, sizeof bytes)});
    }
  }
  return !gone_;
}

void ClientLines::Finish(const std::string& last_line) {
  sent_.Clear();
  rows_.Add(last_line);
  Send();
  char bytes[1 << 16];
  bool told = false;
  while (!gone_ && (rows_.size() > 0 || !ended_)) {
    if (rows_.size() == 0 && !told) told = shutdown(file_, SHUT_WR) == 0;
    const bool waits = rows_.size() > 0;
    const auto events =
        static_cast<short>((waits ? POLLOUT : 0) | (ended_ ? 0 : POLLIN));
    const int found = Wait(events, waits ? -1 : 1000 * kPatience_s);
    if (found <= 0) break;
    if ((found & (POLLOUT | kBroken)) != 0) Send();
    if ((found & (POLLIN | kBroken)) != 0) Receive(bytes, sizeof bytes);
  }
  // TCP throws lines away that are on their way where a socket is closed with
  // bytes that nobody has read.
  for (int i = 0; i < 256 && !ended_ && Receive(bytes, sizeof bytes) > 0; ++i) {
  }
}

}  // namespace finray

#ifndef FINRAY_APPS_CLIENT_LINES_H_
#define FINRAY_APPS_CLIENT_LINES_H_

#include <atomic>
#include <cstddef>
#include <string>
#include <string_view>

namespace finray {

/// The lines that a client of a socket sends and gets, for the thread of its
/// session. The client need not read before it has written all: rows that it
/// does not take wait here, and while kMostRows_bytes of them do, so do lines
/// that it sends. The socket is given whole lines only, as far as it has room
/// for them, so that whatever ends the session ends it at the end of a line.
class ClientLines {
 public:
  /// `file` is the connected socket, which the caller closes. `name` is that of
  /// the client in messages. All calls return soon after `stop_file` can be
  /// read.
  ClientLines(int file, int stop_file, const std::string& name);
  ~ClientLines();
  ClientLines(const ClientLines&) = delete;
  ClientLines& operator=(const ClientLines&) = delete;

  /// A ByteSource: what the client has sent. Throws InputError if the
  /// connection has broken.
  int Read(char* buffer, int size);
  /// Sends a line with its end, or keeps it. Returns false if the client has
  /// gone, or if told to end. Throws InputError if both queues are full and
  /// nothing moves for kPatience_s: the client writes and does not read.
  bool Write(std::string_view line);
  /// Sends what waits and then `last_line` ("": none), and takes what the
  /// client still sends, which does not count any more. Returns once the client
  /// has all and sends nothing.
  void Finish(const std::string& last_line);
  /// Lets all calls return. From any thread.
  void Leave();
  bool left() const { return left_; }

  static constexpr std::size_t kMostRows_bytes = 4 << 20,
                               kMostSent_bytes = 8 << 20;
  static constexpr int kPatience_s = 5;

 private:
  // Bytes that are appended at one end and taken from the other.
  class Queue {
   public:
    std::size_t size() const { return bytes_.size() - begin_; }
    std::string_view view() const {
      return std::string_view(bytes_).substr(begin_);
    }
    void Add(std::string_view bytes) { bytes_ += bytes; }
    void Drop(std::size_t count);
    void Clear() { Drop(size()); }

   private:
    std::string bytes_;
    std::size_t begin_ = 0;
  };

  // Waits for events of the socket for at most so many ms (-1: for ever).
  // Returns those that have come, 0 if none has, and -1 if told to end.
  int Wait(short events, int most_ms) const;
  // Sends rows as long as the socket has room for whole lines.
  void Send();
  // Takes what the client has sent. Returns the number of bytes.
  std::size_t Receive(char* buffer, std::size_t size);

  const int file_, stop_file_;
  const std::string name_;
  int leave_;  // can be read after Leave()
  std::atomic<bool> left_{false};
  Queue rows_, sent_;
  // No more bytes come; none can be sent.
  bool ended_ = false, gone_ = false;
  int error_ = 0;  // of the last Receive()
};

}  // namespace finray

#endif  // FINRAY_APPS_CLIENT_LINES_H_

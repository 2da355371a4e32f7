#ifndef FINRAY_VIEW_BOUNDED_HTTP_H_
#define FINRAY_VIEW_BOUNDED_HTTP_H_

#include <httplib.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>

namespace finray {

/// A server of httplib that bounds what a request can cost: one request a
/// connection, of at most kMostBytes with its headers, within a time. Ranges
/// are ignored, as HTTP allows: httplib would copy the page for each of them.
/// For the one source that includes httplib.
class BoundedHttp : public httplib::Server {
 public:
  /// A client has `patience_s` for its request, and as long again whenever it
  /// does not take what is sent.
  explicit BoundedHttp(int patience_s) : patience_(patience_s) {
    set_payload_max_length(kMostBodyBytes);
  }

  static constexpr std::size_t kMostBytes = 16384, kMostBodyBytes = 1024;

 private:
  using Clock = std::chrono::steady_clock;

  class Connection : public httplib::Stream {
   public:
    Connection(socket_t file, std::chrono::seconds patience)
        : file_(file), patience_(patience) {}
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    // Takes what the client still sends, for a while: TCP throws an answer away
    // where a socket is closed with bytes that nobody has read.
    ~Connection() override {
      shutdown(file_, SHUT_WR);
      const Clock::time_point end = Clock::now() + kDrain;
      while (Waits(POLLIN, Until(end)) &&
             recv(file_, bytes_, sizeof bytes_, MSG_DONTWAIT) > 0) {
      }
      httplib::detail::close_socket(file_);
    }

    bool is_readable() const override {
      return begin_ < end_ || Waits(POLLIN, Until(due_));
    }
    bool is_writable() const override { return Waits(POLLOUT, patience_); }
    ssize_t read(char* to, size_t size) override {
      if (begin_ == end_) {
        const std::size_t most = std::min(sizeof bytes_, kMostBytes - taken_);
        if (most == 0 || !Waits(POLLIN, Until(due_))) return -1;
        const ssize_t count = recv(file_, bytes_, most, MSG_DONTWAIT);
        if (count <= 0) return count;
        begin_ = 0;
        end_ = static_cast<std::size_t>(count);
        taken_ += end_;
      }
      const std::size_t count = std::min(size, end_ - begin_);
      std::copy_n(bytes_ + begin_, count, to);
      begin_ += count;
      return static_cast<ssize_t>(count);
    }
    ssize_t write(const char* bytes, size_t size) override {
      if (!is_writable()) return -1;
      return send(file_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return file_; }

   private:
    static constexpr std::chrono::milliseconds kDrain{300};

    static std::chrono::milliseconds Until(Clock::time_point end) {
      return std::max(std::chrono::milliseconds(0),
                      std::chrono::duration_cast<std::chrono::milliseconds>(
                          end - Clock::now()));
    }
    bool Waits(short events, std::chrono::milliseconds wait) const {
      pollfd waiting = {file_, events, 0};
      return poll(&waiting, 1, static_cast<int>(wait.count())) > 0;
    }

    const socket_t file_;
    const std::chrono::seconds patience_;
    const Clock::time_point due_ = Clock::now() + patience_;
    char bytes_[4096];
    std::size_t begin_ = 0, end_ = 0, taken_ = 0;
  };

  bool process_and_close_socket(socket_t file) override {
    Connection connection(file, patience_);
    bool closed = false;
    return process_request(
        connection, true, closed,
        [](httplib::Request& request) { request.ranges.clear(); });
  }

  const std::chrono::seconds patience_;
};

}  // namespace finray

#endif  // FINRAY_VIEW_BOUNDED_HTTP_H_

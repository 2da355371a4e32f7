#include "listen.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <list>
#include <memory>
#include <string_view>
#include <thread>

#include "app.h"
#include "client_lines.h"
#include "finray/batch/estimation_warnings.h"

namespace finray {
namespace {

constexpr int kQueue = 16;  // clients that wait to be accepted

[[noreturn]] void FailListening(const std::string& address,
                                const std::string& why) {
  throw InputError("cannot listen at " + address + ": " + why);
}

// A socket that listens, and what it leaves behind.
class Listener {
 public:
  explicit Listener(const std::string& address) : address_(address) {
    constexpr char kUnix[] = "unix:";
    if (address.rfind(kUnix, 0) == 0) {
      ListenAtPath(address.substr(sizeof kUnix - 1));
    } else {
      ListenAtPort();
    }
  }
  ~Listener() {
    close(file_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int file() const { return file_; }
  /// The address, with the port that was found for 0.
  const std::string& address() const { return address_; }
  bool is_unix() const { return !path_.empty(); }

 private:
  void Open(int family) {
    file_ = socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (file_ < 0) FailListening(address_, std::strerror(errno));
  }
  void Bind(const sockaddr* to, socklen_t size) {
    if (bind(file_, to, size) == 0 && listen(file_, kQueue) == 0) return;
    const std::string why = std::strerror(errno);
    close(file_);
    FailListening(address_, why);
  }

  // Only this user can connect. A socket that nobody serves any more is
  // replaced.
  void ListenAtPath(const std::string& path) {
    sockaddr_un to = {};
    to.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof to.sun_path) {
      throw UsageError("--listen: expected unix: and a path of 1 to " +
                       std::to_string(sizeof to.sun_path - 1) +
                       " bytes, found " + std::to_string(path.size()));
    }
    path.copy(to.sun_path, path.size());
    const auto* generic = reinterpret_cast<const sockaddr*>(&to);
    struct stat found;
    if (lstat(path.c_str(), &found) == 0) {
      if (!S_ISSOCK(found.st_mode)) {
        FailListening(address_, "the path is there and is no socket");
      }
      Open(AF_UNIX);
      const bool served = connect(file_, generic, sizeof to) == 0;
      const int error = errno;
      close(file_);
      if (served) FailListening(address_, "another process serves it");
      if (error != ECONNREFUSED) {
        FailListening(address_, std::strerror(error));
      }
      unlink(path.c_str());
    }
    Open(AF_UNIX);
    const mode_t before = umask(0177);
    // The mode of the path is that of the socket at the time of bind().
    Bind(generic, sizeof to);
    umask(before);
    path_ = path;
  }

  void ListenAtPort() {
    const std::size_t colon = address_.rfind(':');
    std::string host = "127.0.0.1", port = address_;
    if (colon != std::string::npos) {
      host = address_.substr(0, colon);
      port = address_.substr(colon + 1);
      if (host.size() > 1 && host.front() == '[' && host.back() == ']') {
        host = host.substr(1, host.size() - 2);
      }
    }
    if (host.empty() || port.empty() || port.size() > 5 ||
        port.find_first_not_of("0123456789") != std::string::npos ||
        std::stoi(port) > 65535) {
      throw UsageError(
          "--listen: expected unix:PATH, PORT or ADDRESS:PORT with a port of 0 "
          "to 65535, found '" +
          address_ + "'");
    }
    addrinfo hints = {}, *found = nullptr;
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
    if (error != 0) FailListening(address_, gai_strerror(error));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found,
                                                               freeaddrinfo);
    Open(found->ai_family);
    const int yes = 1;
    setsockopt(file_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    Bind(found->ai_addr, found->ai_addrlen);
    sockaddr_storage at = {};
    socklen_t size = sizeof at;
    getsockname(file_, reinterpret_cast<sockaddr*>(&at), &size);
    // sin6_port lies where sin_port does.
    const int number = ntohs(reinterpret_cast<sockaddr_in*>(&at)->sin_port);
    const bool is_ipv6 = host.find(':') != std::string::npos;
    address_ =
        (is_ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(number);
    if (IsLoopback(host)) return;
    Warn("other machines reach " + address_ + ", and nothing asks who they are",
         "listen at 127.0.0.1 and let them come through ssh -L");
  }

  std::string address_, path_;
  int file_ = -1;
};

// A client and its thread.
class Session {
 public:
  // Takes the socket once the thread is there; a constructor that throws leaves
  // it to the caller.
  Session(const BatchSettings& settings, const FollowSettings& follow, int file,
          int number)
      : settings_(settings),
        follow_(follow),
        file_(file),
        lines_(file, follow.stop_file, "client " + std::to_string(number)) {
    follow_.source = "client " + std::to_string(number);
    follow_.read = [this](char* buffer, int size) {
      return lines_.Read(buffer, size);
    };
    follow_.write = [this](std::string_view row) {
      const bool open = lines_.Write(row);
      answered_ = Clock::now();
      follows_ = true;
      return open;
    };
    follow_.stop = [this, stop = follow.stop] {
      return stop() || lines_.left();
    };
    follow_.warn_of_finger = false;
    thread_ = std::thread([this] { Serve(); });
  }
  ~Session() {
    lines_.Leave();
    thread_.join();
    close(file_);
  }
  bool ended() const { return ended_; }

  // Since the last row, or since it is connected.
  std::chrono::seconds silent() const {
    return std::chrono::duration_cast<std::chrono::seconds>(Clock::now() -
                                                            answered_.load());
  }
  bool makes_room() const {
    return silent().count() >= (follows_ ? kRowPatience_s : kHeaderPatience_s);
  }
  // Tells the client to leave.
  void MakeRoom() {
    makes_room_ = true;
    lines_.Leave();
  }

 private:
  using Clock = std::chrono::steady_clock;

  void Serve() {
    std::string error;
    try {
      if (const auto followed = FollowInput(settings_, follow_)) {
        Report(*followed);
      }
    } catch (const std::exception& thrown) {
      error = thrown.what();
    }
    if (makes_room_) {
      error = follow_.source + ": silent for " +
              std::to_string(silent().count()) +
              " s, and another client needs the place";
    }
    if (!error.empty()) {
      std::fprintf(stderr, "finray_estimate: %s\n", error.c_str());
    }
    // No more rows come: this session is the first to make room for another.
    follows_ = false;
    lines_.Finish(error.empty() ? "" : "# error: " + error + "\n");
    shutdown(file_, SHUT_RDWR);
    ended_ = true;
  }

  // The lines of a session stand together, and each names it.
  void Report(const Followed& followed) const {
    const std::string& client = follow_.source;
    const std::vector<Warning> warnings =
        WarningsOf({{&followed.summary, client}}, settings_.finger);
    flockfile(stderr);
    PrintLatency(client.c_str(), followed.latency);
    PrintEnded((client + " searches").c_str(), followed.summary,
               settings_.scene, stderr);
    Warn(warnings);
    funlockfile(stderr);
  }

  const BatchSettings& settings_;
  FollowSettings follow_;
  const int file_;
  ClientLines lines_;
  std::atomic<Clock::time_point> answered_{Clock::now()};
  std::atomic<bool> follows_{false}, makes_room_{false}, ended_{false};
  std::thread thread_;
};

void PrepareClient(int file, bool is_unix) {
  if (is_unix) return;
  const int yes = 1;
  setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  // Finds out that a machine is gone without a word.
  setsockopt(file, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
}

// Says why, and closes after what has come has been read: TCP throws a last
// line away where bytes are left.
void Dismiss(int file, const std::string& line) {
  send(file, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  shutdown(file, SHUT_WR);
  char bytes[4096];
  while (recv(file, bytes, sizeof bytes, MSG_DONTWAIT) > 0) {
  }
  close(file);
}

void Refuse(int file) {
  const std::string line = "# error: " + std::to_string(kMostClients) +
                           " clients are connected, which is the most\n";
  Dismiss(file, line);
}

// Lets the client leave that has been silent longest, if one may.
bool MakeRoom(std::list<Session>* sessions) {
  auto longest = sessions->end();
  for (auto at = sessions->begin(); at != sessions->end(); ++at) {
    if (!at->makes_room()) continue;
    if (longest == sessions->end() || at->silent() > longest->silent()) {
      longest = at;
    }
  }
  if (longest == sessions->end()) return false;
  longest->MakeRoom();
  sessions->erase(longest);
  return true;
}

}  // namespace

void Listen(const BatchSettings& settings, const std::string& address,
            const FollowSettings& follow_one) {
  const Listener listener(address);
  FrameEstimator prepared(settings.finger, settings.scene,
                          settings.discretization, settings.method);
  prepared.Prepare();
  FollowSettings follow = follow_one;
  follow.prepared = &prepared;
  Warn(WarningsOf(settings.finger, settings.scene));
  std::fprintf(stderr, "listening      %s\n", listener.address().c_str());
  std::list<Session> sessions;
  int clients = 0;
  while (!follow.stop()) {
    pollfd waiting[2] = {{listener.file(), POLLIN, 0},
                         {follow.stop_file, POLLIN, 0}};
    if (poll(waiting, 2, -1) < 0 || waiting[0].revents == 0) continue;
    const int file = accept4(listener.file(), nullptr, nullptr, SOCK_CLOEXEC);
    sessions.remove_if([](const Session& session) { return session.ended(); });
    if (file < 0) {
      // Out of descriptors, say: the clients that there are go on.
      if (errno != EINTR && errno != ECONNABORTED) usleep(100000);
    } else if (sessions.size() >= kMostClients && !MakeRoom(&sessions)) {
      Refuse(file);
    } else {
      PrepareClient(file, listener.is_unix());
      try {
        sessions.emplace_back(settings, follow, file, ++clients);
      } catch (const std::exception& error) {  // no thread to be had
        Dismiss(file, "# error: " + std::string(error.what()) + "\n");
      }
    }
  }
}

}  // namespace finray

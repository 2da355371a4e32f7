#include "finray/view/live_server.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "finray/io/error.h"
#include "finray/view/bounded_http.h"
#include "finray/view/json_text.h"

namespace finray {
namespace {

// Workers in a fixed number, and one more that tells its client that all are
// at work. A connection that finds none waits until one is free, and others
// behind it in the system's queue, which is short.
class BoundedWorkers {
 public:
  explicit BoundedWorkers(int workers) {
    threads_.reserve(static_cast<std::size_t>(workers) + 1);
    try {
      for (int i = 0; i < workers + 1; ++i) {
        threads_.emplace_back([this] { Work(); });
      }
    } catch (const std::system_error&) {
      Join();
      throw;
    }
  }
  ~BoundedWorkers() { Join(); }

  void Add(std::function<void()> task) {
    std::unique_lock<std::mutex> lock(mutex_);
    change_.wait(lock, [&] { return idle_ > 0 || ended_; });
    --idle_;
    tasks_.push_back({std::move(task), idle_ == 0});
    change_.notify_all();
  }
  // Says whether this thread's connection is the one too many.
  static bool is_one_too_many() { return one_too_many; }
  // Lets nobody wait any more.
  void Release() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    change_.notify_all();
  }
  // Waits for what the workers are at.
  void Join() {
    Release();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  struct Task {
    std::function<void()> run;
    bool is_one_too_many;
  };

  void Work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      ++idle_;
      change_.notify_all();
      change_.wait(lock, [&] { return !tasks_.empty() || ended_; });
      if (tasks_.empty()) return;
      const Task task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      one_too_many = task.is_one_too_many;
      task.run();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable change_;
  std::deque<Task> tasks_;
  std::vector<std::thread> threads_;
  int idle_ = 0;
  bool ended_ = false;
  inline static thread_local bool one_too_many = false;
};

// The workers as httplib wants them. It deletes this object whenever it ends to
// listen, so the workers are not its own.
class WorkerQueue : public httplib::TaskQueue {
 public:
  explicit WorkerQueue(BoundedWorkers* workers) : workers_(*workers) {}

  // httplib has changed what this returns.
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));
  Taken enqueue(std::function<void()> task) override {
    workers_.Add(std::move(task));
    return static_cast<Taken>(true);
  }
  void shutdown() override { workers_.Join(); }

 private:
  BoundedWorkers& workers_;
};

// Takes the same time wherever the difference is.
bool IsEqualSecret(const std::string& a, const std::string& b) {
  unsigned difference = a.size() != b.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^
                  static_cast<unsigned char>(b[b.empty() ? 0 : i % b.size()]);
  }
  return difference == 0;
}

}  // namespace

bool IsLoopback(const std::string& address) {
  return address == "localhost" || address == "::1" ||
         (address.compare(0, 4, "127.") == 0 &&
          address.find_first_not_of("0123456789.") == std::string::npos);
}

class LiveServer::Implementation {
 public:
  Implementation(const ServeSettings& settings, Pages pages, const LiveHub* hub)
      : settings_(settings), pages_(std::move(pages)), hub_(*hub) {
    server_.new_task_queue = [this] {
      listens_.set_value();
      return new WorkerQueue(&workers_);
    };
    server_.set_tcp_nodelay(true);
    // Not SO_REUSEPORT, httplib's default: two servers would share a port.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    Route();
    port_ = Bind();
    if (port_ <= 0) {
      throw InputError("cannot serve at " + settings.address + ":" +
                       std::to_string(settings.port) +
                       ": the port is in use, or the address is not of this "
                       "machine");
    }
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // Before that, stop() would do nothing.
    listens_.get_future().wait();
  }
  ~Implementation() {
    // A page that is still to be told of the end is not served after stop().
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::seconds(kPatience_s);
    while (streams_ > 0 && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    server_.stop();
    workers_.Release();
    thread_.join();
  }

  int port() const { return port_; }

 private:
  // Returns the port, or what is not above 0.
  int Bind() {
    const char* address = settings_.address.c_str();
    if (settings_.port == 0) return server_.bind_to_any_port(address);
    return server_.bind_to_port(address, settings_.port) ? settings_.port : 0;
  }

  void Route() {
    server_.set_error_handler([](const auto&, auto& response) {
      if (response.status != 400 || !response.body.empty()) return;
      Refuse(400,
             "expected an HTTP request of at most " +
                 std::to_string(BoundedHttp::kMostBytes) + " bytes within " +
                 std::to_string(kPatience_s) + " s",
             &response);
    });
    server_.set_pre_routing_handler([](const auto&, auto& response) {
      if (!BoundedWorkers::is_one_too_many()) {
        return httplib::Server::HandlerResponse::Unhandled;
      }
      response.set_header("Connection", "close");
      Refuse(503,
             "This live page can take no more connections: " +
                 std::to_string(kWorkers) +
                 " are open. Close one, then load it again.",
             &response);
      return httplib::Server::HandlerResponse::Handled;
    });
    server_.Get("/", [this](const auto& request, auto& response) {
      if (!Admits(request, &response)) return;
      response.set_header("Cache-Control", "no-store");
      response.set_content(pages_.page, "text/html; charset=utf-8");
    });
    server_.Get("/finger.yaml", [this](const auto& request, auto& response) {
      if (!Admits(request, &response)) return;
      response.set_header("Cache-Control", "no-store");
      response.set_content(pages_.finger_yaml(), "application/yaml");
    });
    server_.Post("/zero", [this](const auto& request, auto& response) {
      if (!Admits(request, &response)) return;
      if (!request.has_header("X-Finray")) {
        Refuse(403, "expected the header X-Finray", &response);
        return;
      }
      response.set_content(pages_.zero(), "text/plain; charset=utf-8");
    });
    server_.Get("/events", [this](const auto& request, auto& response) {
      if (Admits(request, &response)) Stream(&response);
    });
  }

  bool Admits(const httplib::Request& request, httplib::Response* response) {
    if (!settings_.token.empty()) {
      if (IsEqualSecret(request.get_param_value("token"), settings_.token)) {
        return true;
      }
      Refuse(403, "expected ?token=... as on the console", response);
      return false;
    }
    std::string host = request.get_header_value("Host");
    if (!host.empty() && host[0] == '[') {
      host = host.substr(1, host.find(']') - 1);
    } else {
      host = host.substr(0, host.find(':'));
    }
    if (IsLoopback(host)) return true;
    Refuse(403, "this page is for this machine only", response);
    return false;
  }

  static void Refuse(int status, const std::string& why,
                     httplib::Response* response) {
    response->status = status;
    response->set_content(why + "\n", "text/plain; charset=utf-8");
  }

  // What came before a page was opened, as one event.
  static std::string PastEvent(const std::vector<LiveHub::Update>& updates) {
    if (updates.empty()) return "";
    JsonArray array;
    for (const LiveHub::Update& update : updates) array.Add(*update);
    return "event: past\ndata: " + array.str() + "\n\n";
  }

  // Server-sent events until the client goes or the log ends.
  void Stream(httplib::Response* response) {
    if (++streams_ > kMostPages) {
      --streams_;
      Refuse(503,
             std::to_string(kMostPages) +
                 " live pages are open, and no more are served. Close one, and "
                 "this one goes on.",
             response);
      return;
    }
    response->set_header("Cache-Control", "no-store");
    auto reader = std::make_shared<LiveHub::Reader>();
    response->set_chunked_content_provider(
        "text/event-stream",
        [this, reader](std::size_t, httplib::DataSink& sink) {
          const LiveHub::News news =
              hub_.Next(reader.get(), std::chrono::milliseconds(500));
          std::string text = news.past ? PastEvent(news.updates) : "";
          for (std::size_t i = 0; !news.past && i < news.updates.size(); ++i) {
            text += "data: " + *news.updates[i] + "\n\n";
          }
          if (news.closed) text += "event: end\ndata: {}\n\n";
          // Page and server both find out whether the other is still there.
          if (text.empty()) text = "event: alive\ndata: {}\n\n";
          const bool open = sink.write(text.data(), text.size());
          if (news.closed) sink.done();
          return open;
        },
        [this](bool) { --streams_; });
  }

  ServeSettings settings_;
  Pages pages_;
  const LiveHub& hub_;
  std::atomic<int> streams_{0};
  std::promise<void> listens_;
  BoundedHttp server_{kPatience_s};
  BoundedWorkers workers_{kWorkers};
  int port_ = 0;
  std::thread thread_;
};

LiveServer::LiveServer(const ServeSettings& settings, Pages pages,
                       const LiveHub* hub)
    : implementation_(
          std::make_unique<Implementation>(settings, std::move(pages), hub)) {}

LiveServer::~LiveServer() = default;

int LiveServer::port() const { return implementation_->port(); }

}  // namespace finray

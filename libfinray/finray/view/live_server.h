#ifndef FINRAY_VIEW_LIVE_SERVER_H_
#define FINRAY_VIEW_LIVE_SERVER_H_

#include <functional>
#include <memory>
#include <string>

#include "finray/view/live_hub.h"

namespace finray {

/// Where a live page is served, and to whom.
struct ServeSettings {
  std::string address = "127.0.0.1";
  int port = 0;       ///< 0: any free one.
  std::string token;  ///< Pages and requests need ?token=...; "": none.
};

/// Says whether only this machine reaches an address.
bool IsLoopback(const std::string& address);

/// Serves a live page over HTTP: `/` is the page, `/events` its updates,
/// `/zero` (POST) asks for new offsets, `/finger.yaml` is the finger in force.
///
/// Without a token it answers only requests whose Host is this machine, so that
/// no other page in a user's browser can reach it under a name of its own.
/// `/zero` also needs the header X-Finray, which such a page cannot send.
///
/// All that clients can do is bounded: kWorkers connections are served at a
/// time, one more is told so (503), and a few wait in the system's queue;
/// kMostPages of them may be pages that get updates. A request has to be there
/// within kPatience_s and is bounded (BoundedHttp); a client that takes nothing
/// for kPatience_s is disconnected.
class LiveServer {
 public:
  struct Pages {
    std::string page;
    std::function<std::string()> zero, finger_yaml;
  };

  /// Starts to serve; `hub` must outlive the server. Throws InputError if the
  /// port cannot be had.
  LiveServer(const ServeSettings& settings, Pages pages, const LiveHub* hub);
  /// Waits until the pages have been told of the hub's end, for at most
  /// kPatience_s, so the hub is to be closed before.
  ~LiveServer();

  int port() const;

  static constexpr int kWorkers = 12, kMostPages = 8, kPatience_s = 5;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_SERVER_H_

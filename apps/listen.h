#ifndef FINRAY_APPS_LISTEN_H_
#define FINRAY_APPS_LISTEN_H_

#include <string>

#include "follow_input.h"

namespace finray {

/// Serves the line protocol (docs/reference/line_protocol.md) to the clients of
/// a socket until it is stopped. Each client has a session of its own, with a
/// thread and an estimator: what it sends and the rows that it gets are those
/// of FollowInput. All estimators share the tables of one. A client that sends
/// nonsense, does not read or goes away ends its own session only. At most
/// kMostClients are served at a time. For one more, the one that has been
/// silent longest makes room, if it has sent no header for kHeaderPatience_s or
/// no row for kRowPatience_s; else the new one is refused.
///
/// `address` is "unix:PATH", "PORT" (of 127.0.0.1) or "ADDRESS:PORT". Throws
/// UsageError if it is none of these, InputError if it cannot be had.
void Listen(const BatchSettings& settings, const std::string& address,
            const FollowSettings& follow);

constexpr int kMostClients = 16;
constexpr int kHeaderPatience_s = 5, kRowPatience_s = 60;

}  // namespace finray

#endif  // FINRAY_APPS_LISTEN_H_

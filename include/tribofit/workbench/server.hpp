#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/workbench/session.hpp"

namespace tribofit {

/// Names and values of conditions as the command line takes them: "radius", "15mm"; empty: not stated.
using StatedConditions = std::vector<std::pair<std::string, std::string>>;

/// A session of the same trace with other conditions. Throws InputError for what cannot be read.
using Reread = std::function<std::unique_ptr<WorkbenchSession>(const StatedConditions&)>;

/// Serves a session to browsers on this machine: the page of the workbench, and what it asks for.
///
/// It listens on 127.0.0.1 only. Every request needs the token of address() (the page in its address, all else in a
/// header), a Host that is this server and, where the browser names them, an Origin and a fetch site that are; so no
/// other page the user has open can talk to it. It serves no files. Requests are small, are given up when their page
/// has sent a newer one, and are answered in JSON, errors as {"problem", "why", "suggestion"}.
class WorkbenchServer {
 public:
  /// port: 0 takes a free one. reread: where conditions can be changed; the session that it makes takes the place of
  /// the one before. Throws InputError where the port is not free, or where this build has no page.
  WorkbenchServer(WorkbenchSession& session, int port, Reread reread = {});
  ~WorkbenchServer();
  WorkbenchServer(const WorkbenchServer&) = delete;
  WorkbenchServer& operator=(const WorkbenchServer&) = delete;

  int port() const;
  /// With the token: "http://127.0.0.1:40123/?token=...".
  std::string address() const;
  const std::string& token() const;

  /// Answers until stop() is called from another thread; at once over where that was before.
  void run();
  /// Ends run() once what is being answered has been; pending requests are given up.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tribofit

/// Everything that the studio does, behind messages (tools/studio/protocol.md). It knows nothing of HTTP.
#pragma once
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/document.h"
#include "tools/studio/session/jobs.h"
#include "tools/studio/session/left_over.h"
#include "tools/studio/session/results.h"
#include "tools/studio/session/sent_view.h"

namespace loopwright::studio {

/// Sends a text to a client. Called from any thread.
using Send = std::function<void(int64_t client, std::string text)>;

class Session {
 public:
  /// `opened`: the file named on the command line, relative to the folder; empty: none.
  Session(std::string folder, std::string opened, Send send);

  /// Answers a message of a client, now or later. Never throws.
  void receive(int64_t client, std::string_view text);
  void disconnect(int64_t client);
  /// Looks for changes from outside; called several times a second while a page is open.
  void look();
  /// Stores a part of a dropped record. Throws Refused.
  Json store(const std::string& name, int64_t offset, bool is_last, std::string_view bytes);
  size_t jobs() const { return jobs_.waiting_or_running(); }

 private:
  struct Request {
    int64_t client = 0, id = 0;
    Value message;
    const Value* find(std::string_view name) const;
    std::string text(std::string_view name) const;  ///< empty if there is none
    std::string required(std::string_view name) const { return required_text(message, name); }
    int64_t whole(std::string_view name, int64_t otherwise) const {
      return optional_whole(message, name, otherwise);
    }
    double number(std::string_view name, double otherwise) const;
    bool flag(std::string_view name) const;
    std::vector<std::string> texts(std::string_view name) const;  ///< empty if there is none
    std::map<std::string, std::string> text_map(std::string_view name) const;
    LoadOptions options() const;  ///< "set" and "variants"
  };
  using Handler = Json (Session::*)(const Request&);

  /// What a long job is given.
  struct Work {
    Session& session;
    Job& job;
    int64_t client, id;
    void progress(std::string_view stage, double done) const;
    void partial(Json part) const;
  };

  static const std::map<std::string_view, Handler>& handlers();
  void answer(const Request& request, Handler handler);
  void send(int64_t client, const Json& message) const;
  void fail(int64_t client, int64_t id, const std::exception& error) const;
  /// Runs `work` as a job; it has no access to documents.
  Json start(const Request& request, std::function<Json(Work&)> work);

  // ---- Documents (session.cpp) ----
  struct Seen {
    std::string inside;
    Variants variants;
    SentView sent = {};
  };
  Json hello(const Request&);
  Json files(const Request&);
  Json remove_left_over(const Request&);
  Json open(const Request&);
  Json edit(const Request&);     // session_edits.cpp
  Json undo(const Request&);     // session_edits.cpp
  Json redo(const Request&);     // session_edits.cpp
  Json resolve(const Request&);  // session_edits.cpp
  Json copy(const Request&);     // session_edits.cpp
  Json cancel(const Request&);
  Json file_list() const;
  Json left_over_list() const;
  std::string first_that_runs() const;
  std::string openable(const std::string& file) const;
  void look_for_files();
  Document& document(const std::string& path);
  Json document_json(const Document& document, Seen& seen, bool with_text);
  /// Changes a document as `change` says; again if another program changed the file at the same moment.
  Json changed(const Request& request, const std::function<Edited(Document&)>& change);
  void tell_others(const Document& document, int64_t except);
  std::vector<std::string> recorded(const Document& document, const LoadOptions& options) const;
  std::string file_of(const Request& request) const { return folder_.path_of(request.required("path")); }

  // ---- Help (session_help.cpp) ----
  Json find_blocks(const Request&);
  Json type(const Request&);
  Json complete(const Request&);
  Json hover(const Request&);

  // ---- Runs (session_runs.cpp) ----
  Json run(const Request&);
  Json signals(const Request&);
  Json export_view(const Request&);
  Json runs(const Request&);
  Json name_run(const Request&);
  Json linearize(const Request&);    // session_linear.cpp
  Json sweep(const Request&);        // session_sweep.cpp
  Json write_sweep(const Request&);  // session_sweep.cpp
  Json fit(const Request&);          // session_fit.cpp
  Json write_fit(const Request&);    // session_fit.cpp
  /// The text of a diagram, as it is open or on the disk.
  std::shared_ptr<const SourceFile> source(const std::string& path);
  std::shared_ptr<const Signals> source_of_signals(const std::string& name) const;

  // ---- Measurements and diagnosis (session_measurements.cpp, session_diagnosis.cpp) ----
  Json columns(const Request&);
  Json write_experiment(const Request&);
  Json compare(const Request&);
  Json diagnose(const Request&);
  Json preview(const Request&);
  Json add_effects(const Request&);

  const Folder folder_;
  std::string opened_;  ///< shown first
  const Send send_;
  std::mutex mutex_;  ///< of the documents and of what the clients see
  std::map<std::string, std::unique_ptr<Document>> documents_;
  std::map<int64_t, std::map<std::string, Seen>> seen_;
  std::vector<Folder::File> files_;
  std::vector<LeftOver> left_over_;
  std::chrono::steady_clock::time_point next_look_for_files_;
  mutable Results results_;
  Jobs jobs_;  ///< last: its threads end before anything else
};

}  // namespace loopwright::studio

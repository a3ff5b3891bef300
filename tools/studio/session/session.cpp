#include "tools/studio/session/session.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include "engine/diagram/in_memory.h"
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "tools/studio/session/followers.h"
#include "tools/studio/session/kept_runs.h"

namespace loopwright::studio {

using Kind = Value::Kind;

// ---- Requests ----

const Value* Session::Request::find(std::string_view name) const {
  const Value::Member* member = message.find(name);
  return member && member->value.kind != Kind::null ? &member->value : nullptr;
}

std::string Session::Request::text(std::string_view name) const {
  return std::string(text_in(message, name));
}

double Session::Request::number(std::string_view name, double otherwise) const {
  const Value* value = find(name);
  return value && value->kind == Kind::number ? value->number : otherwise;
}

bool Session::Request::flag(std::string_view name) const {
  const Value* value = find(name);
  return value && value->kind == Kind::boolean && value->boolean;
}

std::vector<std::string> Session::Request::texts(std::string_view name) const {
  return find(name) ? required_texts(message, name) : std::vector<std::string>();
}

std::map<std::string, std::string> Session::Request::text_map(std::string_view name) const {
  std::map<std::string, std::string> map;
  const Value* value = find(name);
  if (!value) return map;
  if (value->kind != Kind::object) throw Refused(fmt::format("\"{}\" is no object", name));
  for (const Value::Member& member : value->members)
    map[member.name] = member.value.kind == Kind::text ? member.value.text : to_json(member.value);
  return map;
}

LoadOptions Session::Request::options() const {
  LoadOptions options;
  for (const auto& [path, value] : text_map("set")) options.set.emplace_back(path, value);
  options.variants = text_map("variants");
  return options;
}

// ---- Answers ----

Session::Session(std::string folder, std::string opened, Send send)
    : folder_(std::move(folder)),
      opened_(std::move(opened)),
      send_(std::move(send)),
      files_(folder_.files()),
      left_over_(take_left_over(folder_)) {
  for (auto& run : kept_runs(folder_)) results_.runs.add(std::move(run));
}

void Session::send(int64_t client, const Json& message) const {
  send_(client, message.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void Session::fail(int64_t client, int64_t id, const std::exception& error) const {
  Json json{{"text", printable(error.what())}, {"problems", Json::array()}};
  if (const auto* input = dynamic_cast<const InputError*>(&error)) {
    static const ParsedText nothing("", "{}");
    json["problems"] = problems_json(input->problems.list(), nothing, folder_.path());
  }
  if (dynamic_cast<const NeedsConsent*>(&error)) json["consent"] = true;
  send(client, {{"id", id}, {"error", std::move(json)}});
}

const std::map<std::string_view, Session::Handler>& Session::handlers() {
  static const std::map<std::string_view, Handler> map = {
      {"hello", &Session::hello},
      {"files", &Session::files},
      {"remove_left_over", &Session::remove_left_over},
      {"open", &Session::open},
      {"edit", &Session::edit},
      {"undo", &Session::undo},
      {"redo", &Session::redo},
      {"resolve", &Session::resolve},
      {"copy", &Session::copy},
      {"cancel", &Session::cancel},
      {"find_blocks", &Session::find_blocks},
      {"type", &Session::type},
      {"complete", &Session::complete},
      {"hover", &Session::hover},
      {"run", &Session::run},
      {"signals", &Session::signals},
      {"export", &Session::export_view},
      {"runs", &Session::runs},
      {"name_run", &Session::name_run},
      {"linearize", &Session::linearize},
      {"sweep", &Session::sweep},
      {"write_sweep", &Session::write_sweep},
      {"fit", &Session::fit},
      {"write_fit", &Session::write_fit},
      {"columns", &Session::columns},
      {"write_experiment", &Session::write_experiment},
      {"compare", &Session::compare},
      {"diagnose", &Session::diagnose},
      {"preview", &Session::preview},
      {"add_effects", &Session::add_effects},
  };
  return map;
}

void Session::receive(int64_t client, std::string_view text) {
  Request request{client, 0, {}};
  try {
    const ParsedText parsed("request", std::string(text));
    if (!parsed.is_object()) throw Refused("a request is a JSON object: " + parsed.problems.text());
    request.message = parsed.root;
    request.id = request.whole("id", 0);
    const auto handler = handlers().find(request.required("do"));
    if (handler == handlers().end())
      throw Refused(fmt::format("there is no request \"{}\"", request.required("do")));
    answer(request, handler->second);
  } catch (const std::exception& error) {
    fail(client, request.id, error);
  }
}

/// A handler whose answer comes later returns a discarded value.
void Session::answer(const Request& request, Handler handler) {
  const std::lock_guard lock(mutex_);
  Json answer = (this->*handler)(request);
  if (!answer.is_discarded()) send(request.client, {{"id", request.id}, {"ok", std::move(answer)}});
}

void Session::Work::progress(std::string_view stage, double done) const {
  if (!job.is_cancelled())
    session.send(client, {{"id", id}, {"progress", {{"stage", stage}, {"done", done}}}});
}

void Session::Work::partial(Json part) const {
  if (!job.is_cancelled()) session.send(client, {{"id", id}, {"partial", std::move(part)}});
}

Json Session::start(const Request& request, std::function<Json(Work&)> work) {
  const int64_t client = request.client, id = request.id;
  jobs_.start(
      client, id, request.text("lane"),
      [this, client, id, work = std::move(work)](Job& job) {
        Work context{*this, job, client, id};
        try {
          Json answer = work(context);
          if (jobs_.finish(job)) send(client, {{"id", id}, {"ok", std::move(answer)}});
        } catch (const std::exception& error) {
          if (jobs_.finish(job)) fail(client, id, error);
        }
      },
      [this, client, id] {
        send(client, {{"id", id}, {"dropped", true}});
      });
  return Json(Json::value_t::discarded);
}

Json Session::cancel(const Request& request) {
  jobs_.cancel(request.client, request.whole("job", -1));
  return request.id == 0 ? Json(Json::value_t::discarded) : Json::object();
}

void Session::disconnect(int64_t client) {
  jobs_.cancel_all_of(client);
  const std::lock_guard lock(mutex_);
  seen_.erase(client);
}

// ---- Files ----

namespace {

/// Whether a run needs nothing but the file: it loads, and has no inputs that something else must drive.
bool runs_alone(const CheckedText& text) { return text.loads() && !text.checked.is_part(); }

}  // namespace

/// The file to begin with: the first diagram that runs as it is. One with inputs waits for what drives them.
std::string Session::first_that_runs() const {
  constexpr int most_tried = 40;  // a folder of hundreds of diagrams opens without a wait
  std::string first;
  int tried = 0;
  for (const Folder::File& file : folder_.files()) {
    try {
      Problems problems;
      if (!file.path.ends_with(".json") ||
          kind_of_file(folder_.path_of(file.path), problems) != FileKind::diagram)
        continue;
      const auto text = folder_.read(file.path);
      if (first.empty()) first = file.path;
      if (++tried > most_tried) break;
      if (text && runs_alone(check_text(folder_.path_of(file.path), *text, {}))) return file.path;
    } catch (const Refused&) {  // a name or a link that is not served
    }
  }
  return first;
}

Json Session::hello(const Request&) {
  files_ = folder_.files();
  if (opened_.empty()) opened_ = first_that_runs();
  return {{"version", LOOPWRIGHT_VERSION},
          {"folder", std::filesystem::absolute(folder_.path()).lexically_normal().filename().string()},
          {"open", opened_},
          {"files", file_list()},
          {"left_over", left_over_list()}};
}

// ---- Documents ----

Document& Session::document(const std::string& path) {
  auto& entry = documents_[path];
  if (!entry) {
    try {
      entry = std::make_unique<Document>(folder_, path);
    } catch (...) {
      documents_.erase(path);
      throw;
    }
  }
  return *entry;
}

Json Session::document_json(const Document& document, Seen& seen, bool with_text) {
  LoadOptions options;
  options.variants = seen.variants;
  const CheckedText text = check_text(folder_.path_of(document.path()), document.text(), options);
  Json json{{"path", document.path()}, {"revision", document.revision()}};
  if (with_text) json["text"] = document.text();
  json["saved"] = document.is_saved();
  json["writable"] = folder_.is_writable(document.path());
  json["conflict"] = nullptr;
  if (document.conflict()) json["conflict"] = {{"theirs", *document.conflict()}, {"mine", document.text()}};
  json["undo"] = document.undo_text(), json["redo"] = document.redo_text();
  json["loads"] = text.loads(), json["runs_alone"] = runs_alone(text);
  json["summary"] = text.checked.summary();
  json["problems"] = problems_json(text.problems.list(), *text.parsed, folder_.path());
  try {
    json["view"] = view_json(text, seen.inside, seen.variants, document.layout());
  } catch (const Refused&) {  // the level is gone: what contains it is shown
    json["view"] = view_json(text, "", seen.variants, document.layout());
  }
  if (json["view"].is_object())
    for (Json& block : json["view"]["blocks"]) block["file"] = openable(block["file"]);
  seen.sent.shorten(json["view"]);
  return json;
}

Json Session::open(const Request& request) {
  const std::string path = request.required("path");
  Document& opened = document(path);
  if (opened.look()) tell_others(opened, request.client);
  Seen& seen = seen_[request.client][path];
  seen = {request.text("inside"), request.text_map("variants")};
  return document_json(opened, seen, true);
}

void Session::tell_others(const Document& document, int64_t except) {
  for (auto& [client, paths] : seen_) {
    const auto seen = paths.find(document.path());
    if (client == except || seen == paths.end()) continue;
    send(client, {{"event", "document"}, {"document", document_json(document, seen->second, true)}});
  }
}

void Session::look() {
  const std::lock_guard lock(mutex_);
  look_for_files();
  for (auto& [path, document] : documents_) {
    try {
      if (document->look()) tell_others(*document, 0);
    } catch (const std::exception&) {  // another program is writing it: the next look will see it
    }
  }
}

}  // namespace loopwright::studio

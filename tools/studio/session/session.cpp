#include "tools/studio/session/session.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include "engine/diagram/in_memory.h"
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "tools/studio/session/copied_blocks.h"
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
      files_(folder_.files()) {
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
  send(client, {{"id", id}, {"error", std::move(json)}});
}

const std::map<std::string_view, Session::Handler>& Session::handlers() {
  static const std::map<std::string_view, Handler> map = {
      {"hello", &Session::hello},
      {"files", &Session::files},
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
          {"files", file_list()}};
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

namespace {

/// The blocks of a level that were changed, or that contain a change.
std::set<std::string> names_in_level(const std::vector<std::string>& paths, const std::string& inside) {
  std::set<std::string> names;
  const std::string prefix = inside.empty() ? "" : inside + ".";
  for (const std::string& path : paths)
    if (path.starts_with(prefix))
      names.insert(path.substr(prefix.size(), path.find('.', prefix.size()) - prefix.size()));
  return names;
}

Json edits_json(const Edited& edited) {
  const Utf16 places(edited.before);
  Json list = Json::array();
  for (const TextChange& change : edited.changes)
    list.push_back(
        {{"from", places.units(change.from)}, {"to", places.units(change.to)}, {"text", change.text}});
  return list;
}

}  // namespace

Json Session::changed(const Request& request, const std::function<Edited(Document&)>& change) {
  constexpr int most_attempts = 5;
  Document& changed = document(request.required("path"));
  for (int attempt = 1;; ++attempt) {
    if (changed.look()) tell_others(changed, 0);
    try {
      const Edited edited = change(changed);
      Seen& seen = seen_[request.client][changed.path()];
      Json others = Json::array();
      for (const OtherFile& other : edited.others)
        if (!other.path.ends_with(".layout.json"))
          others.push_back({{"path", other.path}, {"text", other.after.value_or("")}});
      Json answer{{"edits", edits_json(edited)},
                  {"document", nullptr},
                  {"blocks", names_in_level(edited.blocks, seen.inside)},
                  {"experiments", std::move(others)}};
      tell_others(changed, request.client);
      answer["document"] = document_json(changed, seen, false);  // last: what it says was sent is sent
      return answer;
    } catch (const ChangedMeanwhile&) {
      if (attempt == most_attempts) throw;
    }
  }
}

std::vector<std::string> Session::recorded(const Document& document, const LoadOptions& options) const {
  const CheckedText text = check_text(folder_.path_of(document.path()), document.text(), options);
  std::vector<std::string> names;
  if (text.checked.plan)
    for (const Plan::Logged& logged : text.checked.plan->log) names.push_back(logged.name);
  return names;
}

Json Session::edit(const Request& request) {
  const Value* intents = request.find("intents");
  if (!intents || intents->kind != Kind::list || intents->items.empty())
    throw Refused("there are no intents");
  const std::string path = request.required("path");
  Seen& seen = seen_[request.client][path];
  if (request.find("variants")) seen.variants = request.text_map("variants");
  if (request.find("inside")) seen.inside = request.text("inside");
  const int64_t revision = request.whole("revision", -1);
  return changed(request, [&](Document& document) {
    LoadOptions options;
    options.variants = seen.variants;
    const IntentContext context{seen.inside, [&] { return recorded(document, options); },
                                [&](const auto& renamed) { return followers(document, renamed); }};
    return document.edit(intents->items, context, seen.variants,
                         revision < 0 ? document.revision() : revision);
  });
}

Json Session::undo(const Request& request) {
  return changed(request, [](Document& document) { return document.undo(); });
}

Json Session::redo(const Request& request) {
  return changed(request, [](Document& document) { return document.redo(); });
}

Json Session::resolve(const Request& request) {
  const std::string keep = request.required("keep");
  return changed(request, [&](Document& document) {
    if (!document.conflict()) throw Refused("there is no conflict");
    if (keep == "theirs") return document.resolve(*document.conflict());
    if (keep == "mine") return document.resolve(document.text());
    if (keep == "text") return document.resolve(request.required("text"));
    throw Refused("\"keep\" is mine, theirs or text");
  });
}

Json Session::copy(const Request& request) {
  const std::string path = request.required("path");
  const Seen& seen = seen_[request.client][path];
  const ParsedText parsed(path, document(path).text());
  const Level level = find_level(parsed.root, request.text("inside"), seen.variants);
  return {{"text", copied_blocks(level, request.texts("blocks"))}};
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

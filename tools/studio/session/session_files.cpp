/// The files of the folder: which there are, and records that are dropped into it.
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include "engine/json/file_kind.h"
#include "tools/studio/session/session.h"

namespace loopwright::studio {
namespace {

std::string title_of(const std::string& text) {
  const ParsedText parsed("", text);
  return parsed.is_object() ? std::string(text_in(parsed.root, "title")) : "";
}

}  // namespace

Json Session::file_list() const {
  Json list = Json::array();
  for (const Folder::File& file : files_) {
    static const std::map<FileKind, std::string_view> names = {
        {FileKind::unknown, "unknown"},       {FileKind::diagram, "diagram"},
        {FileKind::experiment, "experiment"}, {FileKind::sweep, "sweep"},
        {FileKind::training, "training"},     {FileKind::effect, "effect"},
        {FileKind::device, "device"},         {FileKind::model, "model"}};
    constexpr int64_t largest_with_title = 1 << 18;  // bytes: learned models and their like have none
    std::string kind = "record", title;
    try {
      const std::string path = folder_.path_of(file.path);
      Problems problems;
      if (file.path.ends_with(".json")) kind = names.at(kind_of_file(path, problems));
      if (kind != "record" && file.size < largest_with_title)
        title = title_of(folder_.read(file.path).value_or(""));
    } catch (const Refused&) {  // a name or a link that is not served, or a file that cannot be read
      continue;
    }
    list.push_back({{"path", file.path}, {"kind", kind}, {"title", title}, {"size", file.size}});
  }
  return list;
}

Json Session::files(const Request&) {
  files_ = folder_.files();
  return {{"files", file_list()}};
}

/// Texts that a studio left behind when it was killed, and that are not those of their files.
Json Session::left_over_list() const {
  Json list = Json::array();
  for (const LeftOver& left : left_over_)
    list.push_back({{"file", left.file}, {"path", left.path}, {"when", left.when}, {"text", left.text}});
  return list;
}

Json Session::remove_left_over(const Request& request) {
  const auto left = std::ranges::find(left_over_, request.required("file"), &LeftOver::file);
  if (left == left_over_.end()) throw Refused("no such text was left behind");
  if (!studio::remove_left_over(folder_, *left))
    throw Refused(fmt::format("\"{}\" is another file by now, or cannot be removed", left->file));
  left_over_.erase(left);
  return {{"left_over", left_over_list()}};
}

/// The path of a request for a file that a diagram names; empty if the file is outside of the folder.
std::string Session::openable(const std::string& file) const {
  if (file.empty()) return "";
  const std::string relative =
      folder_.relative(std::filesystem::path(file).lexically_normal().generic_string());
  try {
    folder_.path_of(relative);
  } catch (const Refused&) {
    return "";
  }
  return relative;
}

/// Files that other programs put into the folder, or removed, are listed without being asked for.
void Session::look_for_files() {
  constexpr auto pause = std::chrono::seconds(2);  // between two walks through all folders
  const auto now = std::chrono::steady_clock::now();
  if (now < next_look_for_files_) return;
  next_look_for_files_ = now + pause;
  std::vector<Folder::File> found = folder_.files();
  const auto is_same = [&](const Folder::File& a, const Folder::File& b) {
    return a.path == b.path &&
           (a.size == b.size || documents_.contains(a.path));  // open files tell by themselves
  };
  if (std::ranges::equal(found, files_, is_same)) return;
  files_ = std::move(found);
  const Json event{{"event", "files"}, {"files", file_list()}};
  for (const auto& [client, paths] : seen_) send(client, event);
}

Json Session::store(const std::string& name, int64_t offset, bool is_last, std::string_view bytes) {
  if (name.find('/') != name.npos || name.ends_with(".json"))
    throw Refused("a record is a .csv or .mat file");
  folder_.store_part(name, offset, is_last, bytes);
  return {{"path", name}};
}

}  // namespace loopwright::studio

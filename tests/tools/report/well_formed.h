/// Whether tags are nested correctly: the part of HTML that the report uses.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::report {

/// The error in the tags of a page, "" if every one is closed in order. Scripts and styles are skipped.
inline std::string fault_in_html(std::string_view html) {
  std::vector<std::string> open;
  for (size_t at = 0; (at = html.find('<', at)) != html.npos;) {
    size_t end = at + 1;
    for (char quote = 0; end < html.size() && (quote || html[end] != '>'); ++end)
      if (html[end] == '"') quote = quote ? 0 : '"';
    if (end == html.size()) return "a tag does not end";
    const std::string_view tag = html.substr(at + 1, end - at - 1);
    const std::string name(tag.substr(0, tag.find_first_of(" \n/", 1)));
    at = end + 1;
    if (name.empty() || name == "!DOCTYPE" || name == "meta" || tag.back() == '/') continue;
    if (name[0] == '/') {
      if (open.empty() || open.back() != name.substr(1)) return "<" + name + "> closes nothing";
      open.pop_back();
    } else if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyzG0123456789") != name.npos) {
      return "<" + name + "> is no tag";
    } else {
      open.push_back(name);
      if (name == "script" || name == "style") at = html.find("</" + name, at);
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

}  // namespace loopwright::report

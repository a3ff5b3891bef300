#include "tools/diagnose/search/term_text.h"
#include <fmt/format.h>

namespace loopwright::diagnosis {

std::string describe(const SiteModel& model, const SiteTerm& term) {
  std::string text = fmt::format("{}: {}", model.sites()[size_t(term.site)].name, term.shape->name);
  if (term.variable >= 0) text += fmt::format("({})", model.variables()[size_t(term.variable)].name);
  return text;
}

std::vector<std::string> named_in(const SiteModel& model, const SiteHypothesis& h) {
  std::vector<std::string> list;
  for (const SiteTerm& term : h.terms) list.push_back(describe(model, term));
  for (const int i : h.moved()) list.push_back(model.parameters()[size_t(i)].name);
  return list;
}

}  // namespace loopwright::diagnosis

#include "tools/diagnose/search/term_text.h"
#include <fmt/format.h>

namespace loopwright::diagnosis {

std::string describe(const SiteModel& model, const SiteTerm& term) {
  std::string text = fmt::format("{}: {}", model.sites()[size_t(term.site)].name, term.shape->name);
  if (term.variable >= 0) text += fmt::format("({})", model.variables()[size_t(term.variable)].name);
  return text;
}

}  // namespace loopwright::diagnosis

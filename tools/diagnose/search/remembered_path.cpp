#include "tools/diagnose/search/remembered_path.h"

namespace loopwright::diagnosis {

std::array<std::vector<double>, 3> remembered_along(const SiteModel& model, const SitePass& pass,
                                                    const SiteTerm& term) {
  const SiteVariable& variable = model.variables()[size_t(term.variable)];
  const SignalRecord& record = model.record();
  std::array<std::vector<double>, 3> along;
  for (auto& list : along) list.resize(pass.rows);
  double memory = 0;
  for (size_t k = 0; k < pass.rows; ++k) {
    if (record.begins_at(k)) memory = 0;
    const auto signal = [&](size_t part) { return variable.at(&pass.path[part][k * pass.numbers]); };
    along[0][k] = memory;
    for (size_t part : {size_t{1}, size_t{2}}) {
      memory = term.shape->remembered(memory, signal(part - 1), signal(part), record.step(k) / 2,
                                      term.nonlinear.data());
      along[part][k] = memory;
    }
  }
  return along;
}

}  // namespace loopwright::diagnosis

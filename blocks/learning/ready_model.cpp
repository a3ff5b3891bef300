#include "blocks/learning/ready_model.h"
#include <algorithm>
#include <map>
#include <stdexcept>
#include "engine/json/json.h"

namespace loopwright {
namespace {

/// Null after a problem, including a problem in reading the source.
std::shared_ptr<const ReadyModel> prepare(const Checker& checker, std::string_view name,
                                          const std::string& file,
                                          const std::shared_ptr<const SourceFile>& source) {
  const size_t before = checker.problems().list().size();
  LearnedModel learned;
  if (source) learned = read_model(source, checker.problems());
  const auto& list = checker.problems().list();
  const bool has_errors = std::any_of(list.begin() + ptrdiff_t(before), list.end(), [](const Problem& p) {
    return p.severity == Problem::Severity::error;
  });
  if (!source || has_errors) {
    auto& p = checker.error(name, "the model cannot be used");
    p.found = file;
    p.hint = "loopwright gp train makes models";
    return nullptr;
  }
  try {
    return std::make_shared<const ReadyModel>(std::move(learned));
  } catch (const std::domain_error& failure) {
    checker.error(name, failure.what()).found = file;
    return nullptr;
  }
}

}  // namespace

std::vector<UnitClaim> ReadyModel::unit_claims() const {
  std::vector<UnitClaim> claims;
  const auto claim = [&](std::string_view port, const std::string& text) {
    const auto unit = text.empty() ? std::nullopt : parse_unit(text);
    if (unit) claims.push_back({port, unit->in_si(), "model"});
  };
  claim("$position", learned.position_unit), claim("$command", learned.label_unit);
  return claims;
}

std::shared_ptr<const ReadyModel> ready_model(const Checker& checker, std::string_view name,
                                              const std::string& file) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const ReadyModel>> in_use;  // by content of the file
  const std::string path = checker.resolve_file(name, file);
  const auto source = read_source(path, checker.place(name), checker.problems());
  const std::string key = source ? checker.problems().files().back().hash : "";  // just added
  const std::lock_guard lock(mutex);
  std::erase_if(in_use, [](const auto& entry) { return entry.second.expired(); });
  if (const auto found = in_use.find(key); found != in_use.end())
    if (auto model = found->second.lock()) return model;
  const size_t before = checker.problems().list().size();
  auto model = prepare(checker, name, file, source);
  // A model with problems is not kept: its problems are reported for each use.
  if (model && checker.problems().list().size() == before) in_use[key] = model;
  return model;
}

}  // namespace loopwright

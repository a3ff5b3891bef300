/// Learned models prepared for prediction, shared by all blocks that name the same file.
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include "blocks/learning/model_file.h"
#include "engine/block.h"
#include "models/gp/table.h"

namespace loopwright {

struct ReadyModel {
  explicit ReadyModel(LearnedModel m) : learned(std::move(m)), posterior(learned.model) {}
  /// Built on first use.
  const gp::MeanTable& table() const {
    std::call_once(tabulated_, [this] { table_.emplace(posterior); });
    return *table_;
  }
  /// For the ports of a block that predicts with this model.
  std::vector<UnitClaim> unit_claims() const;
  const LearnedModel learned;
  const gp::Posterior posterior;

 private:
  mutable std::once_flag tabulated_;
  mutable std::optional<gp::MeanTable> table_;
};

/// The model named by the parameter `name`; null after a problem. A file that is in use and has not changed
/// is not prepared again: a sweep loads its diagram for many runs.
std::shared_ptr<const ReadyModel> ready_model(const Checker& checker, std::string_view name,
                                              const std::string& file);

}  // namespace loopwright

/// Matrices and units of a design as text and JSON.
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>
#include "engine/unit/unit.h"

namespace loopwright {

/// The rows of a matrix.
inline nlohmann::ordered_json matrix_json(const Eigen::MatrixXd& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(std::vector<double>(matrix.row(i).begin(), matrix.row(i).end()));
  return rows;
}

inline std::string unit_text(const std::optional<Unit>& unit) { return unit ? to_string(*unit) : ""; }

}  // namespace loopwright

/// Contents of a row of the log: the plan's signals, each axis, and the loop's statistics.
#pragma once
#include <span>
#include "engine/record/recording.h"
#include "hw/device/io_device.h"
#include "hw/realtime/axes.h"
#include "hw/realtime/period.h"

namespace loopwright::hw {

struct LogColumn {
  enum class Kind : uint8_t { time, signal, applied, lateness, step_time, lost };
  std::string name, unit;
  Kind kind = Kind::signal;
  Number number = -1;  ///< of a signal
  size_t output = 0;   ///< of what was applied
};

/// What the loop knows of a cycle in addition to the run and the device.
struct CycleAccount {
  double lateness_s = 0, step_time_s = 0;
  double lost = 0;  ///< instants since the previous row without a row, because no sample arrived
};

/// "time", everything the plan logs, "<axis>.position", "<axis>.command", "<axis>.applied", the statistics.
/// The measured velocity too, if the device measures one. No name occurs twice.
std::vector<LogColumn> log_columns(const Plan& plan, const Hardware& hardware);

/// One row, with as many numbers as columns.
void fill_row(std::span<double> row, std::span<const LogColumn> columns, const Run<double>& run,
              const IoDevice& device, const CycleAccount& account) noexcept;

}  // namespace loopwright::hw

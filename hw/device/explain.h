/// Describes device errors in sentences that name the channel and the value read.
#pragma once
#include "hw/device/input.h"
#include "hw/device/status.h"

namespace loopwright::hw {

/// A fault detected by IoDevice itself; recorded in the loop, described afterwards.
struct Incident {
  enum class What : uint8_t { none, input, numbering, output };
  What what = What::none;
  size_t channel = 0;               ///< index among inputs or outputs of the description
  Reading reading = Reading::good;  ///< of an input
  double number = 0;                ///< raw number of an input, value of an output
  double value_before = 0;          ///< of an input, if it had one
  int in_row = 0;                   ///< consecutive bad readings of this input, including this one
  bool has_begun = false;           ///< a good sample came earlier
  int64_t sample = 0, sample_before = 0;
};

std::string explain(const Incident& incident, const DeviceDescription& device);
/// A sentence without a full stop.
std::string_view sentence_of(Code code);

}  // namespace loopwright::hw

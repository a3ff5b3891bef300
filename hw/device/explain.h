/// What went wrong with a device, as sentences that name the channel and what was read.
#pragma once
#include "hw/device/input.h"
#include "hw/device/status.h"

namespace loopwright::hw {

/// What IoDevice itself found wrong; noted in the loop, worded afterwards.
struct Incident {
  enum class What : uint8_t { none, input, numbering, output };
  What what = What::none;
  size_t channel = 0;               ///< among inputs or outputs of the description
  Reading reading = Reading::good;  ///< of an input
  double number = 0;                ///< raw number of an input, value of an output
  double value_before = 0;          ///< of an input, where there was one
  int in_row = 0;                   ///< bad readings of this input, this one included
  bool has_begun = false;           ///< a good sample came before
  int64_t sample = 0, sample_before = 0;
};

std::string explain(const Incident& incident, const DeviceDescription& device);
/// A sentence without a full stop.
std::string_view sentence_of(Code code);

}  // namespace loopwright::hw

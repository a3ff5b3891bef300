// A block that was compiled against headers with other type sizes.
#include "engine/block/registry.h"

static const bool is_registered = [] {
  auto layout = loopwright::block_layout;
  ++layout[0];
  loopwright::add_block(layout, loopwright::BlockInfo{}, loopwright::Kernels<double>{});
  return true;
}();

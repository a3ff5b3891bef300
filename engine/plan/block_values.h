/// Memory of the blocks that a diagram describes.
#pragma once
#include <memory_resource>
#include <utility>
#include <vector>
#include "engine/block/registry.h"

namespace loopwright {

/// The scalar blocks of a diagram, contiguous in memory. They exist as long as any of them is in use.
class BlockValues {
 public:
  BlockValues() = default;
  BlockValues(const BlockValues&) = delete;
  BlockValues& operator=(const BlockValues&) = delete;
  ~BlockValues() {
    for (const auto& [value, kernels] : values_) kernels->destroy(value);
  }
  void* add(const Kernels<double>& kernels) {
    void* const memory = memory_.allocate(kernels.size, 64);
    kernels.construct(memory);
    values_.emplace_back(memory, &kernels);
    return memory;
  }

 private:
  std::pmr::monotonic_buffer_resource memory_;
  std::vector<std::pair<void*, const Kernels<double>*>> values_;
};

}  // namespace loopwright

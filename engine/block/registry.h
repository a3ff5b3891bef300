/// All block types, by name. Blocks register themselves before main, or when a library of blocks is loaded.
#pragma once
#include <map>
#include "engine/block/info.h"

namespace loopwright {

struct BlockType {
  BlockInfo info;
  Kernels<double> kernels;
};

/// Null when there is no such type.
const BlockType* find_block(std::string_view type);
const std::map<std::string, BlockType, std::less<>>& all_blocks();
/// Registers a type; a second registration of the same name throws std::logic_error.
void add_block(BlockInfo info, const Kernels<double>& kernels);
/// Loads a shared library whose blocks register themselves. Throws std::runtime_error naming the file and the
/// reason.
void load_block_library(const std::string& path);

/// Kernels on SIMD lanes, one table a lane type, filled in the module that is compiled for an instruction
/// set.
template <class Real> std::map<std::string, Kernels<Real>, std::less<>>& lane_kernels();

}  // namespace loopwright

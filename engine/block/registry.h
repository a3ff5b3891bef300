/// All block types, by name. Blocks register themselves before main, or when a library of blocks is loaded.
#pragma once
#include <array>
#include <map>
#include <span>
#include "engine/block/info.h"

namespace loopwright {

struct BlockType {
  BlockInfo info;
  Kernels<double> kernels;
  const FileRead* library = nullptr;  ///< the library of the type; null: the program
};

/// Sizes of the types shared by a library of blocks and the program. They differ if the library was compiled
/// against another version of the headers.
inline constexpr std::array<size_t, 6> block_layout{sizeof(BlockInfo), sizeof(Kernels<double>),
                                                    sizeof(PortInfo),  sizeof(ParameterInfo),
                                                    sizeof(Value),     sizeof(Problem)};

/// Null if there is no such type.
const BlockType* find_block(std::string_view type);
const std::map<std::string, BlockType, std::less<>>& all_blocks();
/// Whether a bare number at this parameter has no unit, instead of the one that fits.
bool is_factor(std::string_view type, std::string_view parameter);
/// Registers a type. A type from a library with a name already in use, or with another layout, is not
/// registered: load_block_library reports it. Two blocks of the same name in the program itself throw
/// std::logic_error.
void add_block(std::span<const size_t> layout, BlockInfo&& info, const Kernels<double>& kernels);
/// Loads a shared library whose blocks register themselves; only once, even if it is named repeatedly. It is
/// a problem if the library cannot be loaded, has no block, or has a block whose name is already in use; then
/// none of its blocks is registered. Its contents become part of the identity of every plan that uses its
/// blocks.
void load_block_library(const std::string& path, Problems& problems);

/// The block probably meant by a type that does not exist: the equivalent of a block with this name elsewhere
/// ("PID", "Scope"), or one with a similar name.
std::string block_type_hint(std::string_view type);

/// Kernels on SIMD lanes, one table for each lane type, filled in the module compiled for an instruction set.
template <class Real> std::map<std::string, Kernels<Real>, std::less<>>& lane_kernels();

}  // namespace loopwright

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
  const FileRead* library = nullptr;  ///< that brought the type; null: the program did
};

/// Sizes of what crosses the border between a library of blocks and the program: they differ when the library
/// was compiled against another version of the headers.
inline constexpr std::array<size_t, 6> block_layout{sizeof(BlockInfo), sizeof(Kernels<double>),
                                                    sizeof(PortInfo),  sizeof(ParameterInfo),
                                                    sizeof(Value),     sizeof(Problem)};

/// Null when there is no such type.
const BlockType* find_block(std::string_view type);
const std::map<std::string, BlockType, std::less<>>& all_blocks();
/// Whether a bare number at this parameter has no unit, instead of the one that fits.
bool is_factor(std::string_view type, std::string_view parameter);
/// Registers a type. What a library brings under a name that is taken, or in another layout, is not taken in:
/// load_block_library tells. Two blocks of one name in the program itself throw std::logic_error.
void add_block(std::span<const size_t> layout, BlockInfo&& info, const Kernels<double>& kernels);
/// Loads a shared library whose blocks register themselves; once, however often it is named. A problem when
/// it cannot be loaded, has no block, or one whose name is taken: then none of its blocks is kept. What its
/// bytes say becomes part of the identity of every plan that uses its blocks.
void load_block_library(const std::string& path, Problems& problems);

/// What was probably meant by a type that does not exist: a block that does what the name says elsewhere
/// ("PID", "Scope"), or one that is written nearly so.
std::string block_type_hint(std::string_view type);

/// Kernels on SIMD lanes, one table a lane type, filled in the module that is compiled for an instruction
/// set.
template <class Real> std::map<std::string, Kernels<Real>, std::less<>>& lane_kernels();

}  // namespace loopwright

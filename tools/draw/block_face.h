/// What a block shows inside in a picture: a gain its number, a transfer function its fraction, a saturation
/// its characteristic.
#pragma once
#include "tools/draw/shown_settings.h"
#include "tools/report/graph.h"

namespace loopwright {

/// `inputs`: the number of wires into the block.
report::GraphFace block_face(const ShownSettings& settings, size_t inputs);

/// The signs of the wires of an input that takes several: "+", "−" of a sum, "×", "÷" of a product.
/// Empty texts for other blocks.
std::vector<std::string> wire_signs(const ShownSettings& settings, size_t wires);

/// Strokes of the characteristic or typical signal of a block type, in [-1, 1]²; empty if it has none.
std::vector<std::vector<std::pair<double, double>>> characteristic(const ShownSettings& settings);

}  // namespace loopwright

/// Blocks with settings that make sense: every occurrence of a type in the diagrams of this repository.
#pragma once
#include <memory>
#include <random>
#include <string>
#include <vector>
#include "tests/blocks/block_under_test.h"

namespace loopwright {

struct Specimen {
  std::string type;
  std::string where;       ///< "relay.json: heater", for messages
  std::string settings;    ///< JSON, numbers in SI, paths absolute
  double sample_time = 0;  ///< s; 0: none
  std::vector<int> wires;  ///< an input each: how many wires or elements it has there
};

/// The different occurrences of a block type in diagrams/; empty when no diagram uses it.
const std::vector<Specimen>& specimens_of(std::string_view type);

/// The block on a test bench, freshly started, all inputs connected.
std::unique_ptr<BlockUnderTest> bench(const Specimen& specimen);

/// A number of any magnitude from 1e-3 to 1e2, of either sign; every eighth is zero.
double random_number(std::mt19937_64& random);

/// Every input of the block anew.
void randomize_inputs(BlockUnderTest& block, std::mt19937_64& random);

/// The instant of a step: samples of a sampled block, milliseconds of another.
double time_of_step(const Specimen& specimen, int step);

/// One step on random inputs and randomly displaced states: outputs, then memory. False if the block refused.
bool random_step(BlockUnderTest& block, const Specimen& specimen, int step, std::mt19937_64& random);

/// All outputs in a row.
std::vector<double> all_outputs(const BlockUnderTest& block);

bool equal_bits(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace loopwright

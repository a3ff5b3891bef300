/// Blocks with realistic settings: every occurrence of a type in the diagrams of this repository.
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
  std::vector<int> wires;  ///< for each input: its number of wires or elements
};

/// The distinct occurrences of a block type in diagrams/; empty if no diagram uses it.
const std::vector<Specimen>& specimens_of(std::string_view type);

/// Of a type whose settings declare ports: with the ports of its first specimen.
const BlockInfo& info_of_specimen(const std::string& type);

/// The block on a test bench, started, with all inputs connected.
std::unique_ptr<BlockUnderTest> bench(const Specimen& specimen);

/// A number of any magnitude from 1e-3 to 1e2, with either sign; every eighth is zero.
double random_number(std::mt19937_64& random);

/// Draws every input of the block again.
void randomize_inputs(BlockUnderTest& block, std::mt19937_64& random);

/// The instant of a step: samples for a sampled block, milliseconds for a continuous one.
double time_of_step(const Specimen& specimen, int step);

/// One step on random inputs and randomly perturbed states: outputs, then memory. False if the block returned
/// a fault.
bool random_step(BlockUnderTest& block, const Specimen& specimen, int step, std::mt19937_64& random);

/// All outputs in a row.
std::vector<double> all_outputs(const BlockUnderTest& block);

bool equal_bits(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace loopwright

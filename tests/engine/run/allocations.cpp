// Counts the allocations of this program.
#include "tests/engine/solve/allocations.cpp"

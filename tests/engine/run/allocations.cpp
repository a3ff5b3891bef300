// This program counts its allocations too.
#include "tests/engine/solve/allocations.cpp"

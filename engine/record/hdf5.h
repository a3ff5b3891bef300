/// Recordings as HDF5 files, for Python, Julia, MATLAB and others.
#pragma once
#include <string>

#include "engine/record/recording.h"

namespace loopwright {

/// Writes a dataset of doubles for each column, under its name, in the order of the columns (the group tracks
/// the order of creation), with the text attribute "unit". A slash in a name becomes "|". The facts are the
/// text dataset "loopwright_facts" with two columns, key and value. The file appears completely or not at
/// all. Throws as write_mat.
void write_hdf5(const std::string& path, const Recording& recording);

}  // namespace loopwright

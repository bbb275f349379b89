#pragma once

#include "results/hdf5.hpp"
#include "results/layout.hpp"

// The CF attributes by which a dataset says what it is.
namespace frahm::results {

// units, long_name, and for a flag flag_values and flag_meanings.  `missing`: also _FillValue, if a float.
// Coordinates have none. Integers and flags have none either: xarray would turn them into floats.
void describe(hdf5::Dataset& dataset, const Variable& variable, bool missing);

// The variable a dataset says it is. Throws StoreError if it does not say so.
Variable described(const hdf5::Dataset& dataset);

// A dimension without a coordinate of its own: the scale 0, 1, 2, ..., to be filled.
Variable index_variable(const std::string& dimension);

// Whether the dataset is such a scale.
bool is_index(const hdf5::Dataset& dataset);

}  // namespace frahm::results

#pragma once

#include "results/hdf5.hpp"
#include "results/layout.hpp"

// The CF attributes that describe a dataset.
namespace frahm::results {

// Writes units, long_name, and of a flag flag_values and flag_meanings.  `missing`: also _FillValue, of
// floats only: xarray would turn integers and flags with one into floats. Coordinates have none.
void describe(hdf5::Dataset& dataset, const Variable& variable, bool missing);

// The variable that a dataset's attributes describe. Throws StoreError if they do not.
Variable described(const hdf5::Dataset& dataset);

// A dimension without a coordinate of its own: the scale 0, 1, 2, ..., to be filled.
Variable index_variable(const std::string& dimension);

// Whether the dataset is such a scale.
bool is_index(const hdf5::Dataset& dataset);

}  // namespace frahm::results

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/hdf5.hpp"
#include "results/layout.hpp"
#include "results/storage.hpp"

// The variables of a group: numbers, and columns along the group's own dimensions.
namespace frahm::results {

// A 1-D dataset that grows at its end, written in whole chunks.
class GrowingColumn {
 public:
  // The dimension scale `variable.name` of the group.
  GrowingColumn(hdf5::Group& group, const Variable& variable);
  // A variable along the dimension `scale` of the group.
  GrowingColumn(hdf5::Group& group, const Variable& variable, const std::string& scale);

  void append(std::span<const double> values);
  void flush();  // writes the values still waiting; append nothing after it

 private:
  void write(std::uint64_t count);

  hdf5::Dataset dataset_;
  Variable variable_;
  Bytes waiting_;              // values not yet written, as stored
  std::uint64_t written_ = 0;  // values in the dataset
};

// Writes checked columns into a group; a dimension without a column of its name gets an index.
void write_columns(hdf5::Group& group, const std::vector<Column>& columns);

// Checks the content of a new group and writes it there.
void write_content(hdf5::Group& group, const GroupContent& content);

// All columns of a group except indices: dimension scales first, then the rest in order of creation.
std::vector<Column> read_columns(const hdf5::Group& group);

// Writes the rows of a RaggedLayout one by one.
class RaggedTable {
 public:
  RaggedTable(hdf5::Group group, const RaggedLayout& layout);

  // row: one number for each row variable.  samples: as many values of each sample variable as the row has
  // samples.
  void append(std::span<const double> row, std::span<const std::vector<double>> samples);
  void flush();

 private:
  hdf5::Group group_;
  RaggedLayout layout_;
  std::uint64_t rows_ = 0, sample_count_ = 0;
  // The scale first, then the variables; the last column of the rows is row_start, if there are samples.
  std::vector<GrowingColumn> row_columns_, sample_columns_;
};

}  // namespace frahm::results

#include <hdf5.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "results/data_reader.hpp"
#include "results/map_writer.hpp"
#include "results/store_error.hpp"
#include "sample.hpp"
#include "temporary_directory.hpp"

namespace test_data_reader {
using namespace frahm::results;

namespace {

void write_text(hid_t object, const char* name, const char* text) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);  // as h5py writes texts
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, static_cast<const void*>(&text));
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

void write_number(hid_t object, const char* name, double value) {
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  H5Sclose(space);
}

template <std::size_t Rank>
hid_t write_numbers(hid_t place, const char* name, hid_t type, const std::array<hsize_t, Rank>& shape,
                    const double* values) {
  const hid_t space = H5Screate_simple(Rank, shape.data(), nullptr);
  const hid_t dataset = H5Dcreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Sclose(space);
  return dataset;
}

// A file such as another program leaves: other number types, texts of variable length, no order of creation.
void write_foreign(const std::filesystem::path& path) {
  constexpr std::array values{0.0, 2.0, -9.0, 7.0};
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t time = write_numbers<1>(group, "time", H5T_STD_I16BE, {4}, values.data());
  write_text(time, "units", "ms");
  write_number(time, "_FillValue", -9.0);
  const hid_t table = write_numbers<2>(group, "table", H5T_IEEE_F32BE, {2, 2}, values.data());
  const hid_t packed = write_numbers<1>(group, "packed", H5T_STD_I32LE, {4}, values.data());
  write_number(packed, "scale_factor", 0.1);
  for (const hid_t dataset : {time, table, packed}) H5Dclose(dataset);
  const hid_t text = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Dclose(H5Dcreate2(file, "operator", text, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Tclose(text);
  H5Gclose(group);
  H5Fclose(file);
}

std::string complaint_about(const DataReader& reader, const std::string& dataset) {
  try {
    reader.read(dataset);
  } catch (const StoreError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a column of a file of ours comes back with its unit") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const DataReader reader(directory / "map.h5");
  const DataColumn omega = reader.read("orbits/omega");
  CHECK(omega.values == std::vector<double>{100, 101, 102});
  CHECK(omega.unit == "rpm");
  CHECK(reader.read("/orbits/omega").values == omega.values);
}

TEST_CASE("a column of another program's file is read whatever its type, its missing values as NaN") {
  const TemporaryDirectory directory;
  write_foreign(directory / "foreign.h5");
  const DataColumn time = DataReader(directory / "foreign.h5").read("run/time");
  REQUIRE(time.values.size() == 4);
  CHECK(time.values[1] == 2.0);
  CHECK(std::isnan(time.values[2]));
  CHECK(time.values[3] == 7.0);
  CHECK(time.unit == "ms");
}

TEST_CASE("what is no column of numbers is refused with its place and what there is") {
  const TemporaryDirectory directory;
  write_foreign(directory / "foreign.h5");
  const DataReader reader(directory / "foreign.h5");
  CHECK_THAT(complaint_about(reader, "run/tiem"),
             Catch::Contains("foreign.h5:/run: has no \"tiem\": there are packed, table, time"));
  CHECK_THAT(complaint_about(reader, "ran/time"), Catch::Contains("has no \"ran\": there are operator, run"));
  CHECK_THAT(complaint_about(reader, "run"), Catch::Contains("has no \"run\""));
  CHECK_THAT(complaint_about(reader, "operator/time"), Catch::Contains("has no \"operator\""));
  CHECK_THAT(complaint_about(reader, "/"), Catch::Contains("is a group"));
  CHECK_THAT(complaint_about(reader, "run/table"), Catch::Contains("has 2 dimensions: must have one"));
  CHECK_THAT(complaint_about(reader, "run/packed"), Catch::Contains("is packed by scale_factor"));
  CHECK_THAT(complaint_about(reader, "operator"), Catch::Contains("/operator: must be numbers"));
  CHECK_THROWS_AS(DataReader(directory / "none.h5"), StoreError);
}
}  // namespace test_data_reader

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/study_source.hpp"
#include "studies/reading/text/toml_reading.hpp"

// Shared by the readers of masses, elements and the excitation.
namespace frahm::studies {

struct NetworkOfStudy {
  mechanics::Network network;
  StudyValues values;
  std::vector<DrivingRecord> driving{};  // of the components that are given by corners, in a transient
};

// The network while it is read.
struct NetworkReading {
  NetworkReading(const StudyContext& study, Parameters& read) : context(study), parameters(read) {}

  const StudyContext& context;
  Parameters& parameters;
  NetworkOfStudy result;
  std::filesystem::path folder{};  // of the files that it names
  bool follows_time = false;       // corners are a course in time, as a record is; otherwise a period

  // A name in use and its owner: `mass "main"`. Nodes, elements and signals share one set of names.
  struct TakenName {
    std::string name, owner;
  };
  std::vector<TakenName> names{{"ground", "the fixed node"}};
  std::vector<Position> masses;  // of the tables of result.network.masses
  struct Table {
    Position position;
    std::string where;
  };
  std::vector<Table> joints;  // of result.network.joints
};

// Keeps elements from the name "damping", which is that of the structure's energies in the record.
void keep_name_of_damping(NetworkReading& reading);

// Refuses a name already in use. key: of the name in the section.
void take_name(NetworkReading& reading, const TomlSection& section, const std::string& name,
               const std::string& owner);

// The node of a name, or nothing.
std::optional<mechanics::Node> find_node(const mechanics::Network& network, const std::string& name);
// The mass or joint that a force acts on, as mechanics::Excitation::node counts them.
std::size_t read_forced_node(const TomlSection& section, const mechanics::Network& network,
                             const std::string& key);
// The mass whose name a key holds. need: "only a mass has initial values".
mechanics::Node read_mass(const TomlSection& section, const mechanics::Network& network,
                          const std::string& key, std::string_view need);

// Names of all nodes, ground first.
std::vector<std::string> node_names(const mechanics::Network& network);

// A value of the network: a number, { value, unit } or an expression of parameters; `otherwise` if the key is
// absent.
StudyValue read_value(NetworkReading& reading, const TomlSection& section, const std::string& key,
                      Quantity quantity, Range range, std::optional<double> otherwise = std::nullopt);
// The same of a key whose range is in the table of keys.
StudyValue read_value(NetworkReading& reading, const TomlSection& section, const std::string& key,
                      Quantity quantity, std::optional<double> otherwise = std::nullopt);
std::optional<StudyValue> read_optional(NetworkReading& reading, const TomlSection& section,
                                        const std::string& key, Quantity quantity);
Range range_in(const TomlSection& section, std::string_view key);

// The same of what stands at one place, by its name in messages: [damping]: rayleigh: a.
StudyValue read_value_at(NetworkReading& reading, const std::string& where, const TomlValue& value,
                         Quantity quantity, Range range);

// [[mass]], [[matrices]], [[element]], [damping] and, if the kind of study has one, [excitation]. Sets the
// quantities of `parameters`. folder: of the matrices.
NetworkOfStudy read_network(const StudyContext& context, const TomlValue& root,
                            const std::filesystem::path& folder, Parameters& parameters, StudyKind kind);

}  // namespace frahm::studies

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/reading/study_reading.hpp"

// Shared by the readers of masses, elements and the excitation.
namespace frahm::studies {

// The network while it is read.
struct NetworkReading {
  NetworkReading(const StudyContext& study, Parameters& read) : context(study), parameters(read) {}

  const StudyContext& context;
  Parameters& parameters;
  NetworkOfStudy result;

  // A name in use and its owner: `mass "main"`. Nodes, elements and signals share one set of names.
  struct TakenName {
    std::string name, owner;
  };
  std::vector<TakenName> names{{"ground", "the fixed node"}};
  std::vector<Position> masses;  // of the tables of result.network.masses
};

// Keeps elements from the name "damping", which is that of the structure's energies in the record.
void keep_name_of_damping(NetworkReading& reading);

// Refuses a name already in use. key: of the name in the section.
void take_name(NetworkReading& reading, const TomlSection& section, const std::string& name,
               const std::string& owner);

// The node of a name, or nothing.
std::optional<mechanics::Node> find_node(const mechanics::Network& network, const std::string& name);

// Names of all nodes, ground first.
std::vector<std::string> node_names(const mechanics::Network& network);

// A value of the network: a number, { value, unit } or an expression of parameters; `otherwise` if the key is
// absent.
StudyValue read_value(NetworkReading& reading, const TomlSection& section, const std::string& key,
                      Quantity quantity, Range range, std::optional<double> otherwise = std::nullopt);
// The same for a key whose range is in the table of keys.
StudyValue read_value(NetworkReading& reading, const TomlSection& section, const std::string& key,
                      Quantity quantity, std::optional<double> otherwise = std::nullopt);
std::optional<StudyValue> read_optional(NetworkReading& reading, const TomlSection& section,
                                        const std::string& key, Quantity quantity);
Range range_in(const TomlSection& section, std::string_view key);

// The law of a coulomb element; exact of every other. Refuses keys of other laws.
mechanics::FrictionLaw read_law(const TomlSection& section, const mechanics::ElementKind& kind);
// Refuses a contact next to others of which some are followed exactly and some are smooth.
void check_one_law(const NetworkReading& reading, const TomlSection& section,
                   const mechanics::ElementKind& kind, mechanics::FrictionLaw law);

// Refuses more contacts than are followed exactly: the exact law knows which stick by the bits of a word.
void check_number_of_contacts(const NetworkReading& reading, const TomlSection& section,
                              const mechanics::Element& element);

// Refuses a mass, or an element with a spring in series, that makes the system too large.
void check_number_of_states(const NetworkReading& reading, const TomlSection& section);

// A spring in series with a slider, as one of those of an iwan element.
struct StudySlider {
  StudyValue stiffness, force;
};
// Those of an iwan element: listed, or of a distribution.
std::vector<StudySlider> read_sliders(NetworkReading& reading, const TomlSection& section, bool rotational);

// An [[element]], after the masses and the nodes of prescribed motion. number: from 1.
void read_element(NetworkReading& reading, const TomlValue& table, std::size_t number);
// Its stops, table or curve of friction, if its kind has such and, of a table, the key is there; the bends go
// to the element.
StudyCharacteristic read_characteristic(NetworkReading& reading, const TomlSection& section, bool rotational,
                                        mechanics::Element& element);
// The same for what stands at one place, by its name in messages: [damping]: rayleigh: a.
StudyValue read_value_at(NetworkReading& reading, const std::string& where, const TomlValue& value,
                         Quantity quantity, Range range);

// [[matrices]]: its degrees of freedom become masses, without mass of their own. folder: of the files.
void read_matrices(NetworkReading& reading, const TomlValue& root, const std::filesystem::path& folder);

// [damping], if there is one, once all masses are there.
void read_damping(NetworkReading& reading, const TomlValue& root);

// [[excitation.motion]] names the nodes of prescribed motion, so it comes before the elements. [excitation]
// with its forces and the frequency comes after the masses. Constant forces alone are refused unless
// constant_will_do: they cause no periodic motion, but a suddenly applied load causes a transient. Without a
// harmonic no frequency is needed: it is 1 rad/s then.
void read_prescribed_nodes(NetworkReading& reading, const TomlValue& excitation);
void read_excitation(NetworkReading& reading, const TomlValue& excitation, bool constant_will_do);

// Refuses elements and signals that ask for the displacement of a node that moves on for ever.
void check_belts(const NetworkReading& reading);

}  // namespace frahm::studies

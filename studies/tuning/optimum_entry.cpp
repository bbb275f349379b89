#include "studies/tuning/optimum_entry.hpp"

#include <bit>
#include <type_traits>

#include "engine/bad_entry.hpp"

namespace frahm::studies {
namespace {

using tuning::LimitState, tuning::Optimum, tuning::Peak, tuning::Round, tuning::TunedParameter;

constexpr std::size_t word = sizeof(std::uint64_t);

// Everything is stored in words of 8 bytes; a text or a list is its length and its content.
class Writing {
 public:
  explicit Writing(engine::Bytes& out) : out_(out) {}

  void take(const std::uint64_t& number) {
    out_.resize(out_.size() + word);
    engine::put_little_endian(out_.data() + out_.size() - word, number);
  }
  void take(const double& number) { take(std::bit_cast<std::uint64_t>(number)); }
  void take(const int& number) { take(static_cast<std::uint64_t>(number)); }
  template <class Choice>
  requires std::is_enum_v<Choice>
  void take(const Choice& choice) { take(static_cast<int>(choice)); }
  void take(const std::string& text) {
    take(std::uint64_t{text.size()});
    const auto bytes = std::as_bytes(std::span(text));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  template <class Item>
  void take(const std::vector<Item>& items) {
    take(std::uint64_t{items.size()});
    for (const Item& item : items) each(*this, item);
  }

 private:
  engine::Bytes& out_;
};

class Reading {
 public:
  explicit Reading(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }
  void take(std::uint64_t& number) { number = engine::get_little_endian<std::uint64_t>(first(word).data()); }
  void take(double& number) { number = std::bit_cast<double>(next()); }
  void take(int& number) { number = static_cast<int>(next()); }
  template <class Choice>
  requires std::is_enum_v<Choice>
  void take(Choice& choice) { choice = static_cast<Choice>(next()); }
  void take(std::string& text) {
    const auto bytes = first(next());
    text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  template <class Item>
  void take(std::vector<Item>& items) {
    const std::uint64_t size = next();
    if (size > bytes_.size() / word) fail();  // every item has a word at least
    items.resize(size);
    for (Item& item : items) each(*this, item);
  }

 private:
  [[noreturn]] static void fail() {
    throw engine::BadEntry("the record of a start is shorter than its header says");
  }
  std::uint64_t next() {
    std::uint64_t number = 0;
    take(number);
    return number;
  }
  std::span<const std::byte> first(std::uint64_t size) {
    if (size > bytes_.size()) fail();
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

  std::span<const std::byte> bytes_;
};

// One list of the members of each type, for writing and reading alike.
template <class Archive, class... Members>
void members(Archive& archive, Members&... all) {
  (archive.take(all), ...);
}

template <class Archive, class Item>
void each(Archive& archive, Item& item) {
  using Plain = std::remove_const_t<Item>;
  if constexpr (std::is_same_v<Plain, TunedParameter>) {
    members(archive, item.value, item.knots, item.at_bound, item.lower_multiplier, item.upper_multiplier);
  } else if constexpr (std::is_same_v<Plain, Peak>) {
    members(archive, item.scenario, item.record, item.at, item.value, item.multiplier, item.sensitivity);
  } else if constexpr (std::is_same_v<Plain, LimitState>) {
    members(archive, item.value, item.at, item.scenario, item.excess, item.multiplier);
  } else if constexpr (std::is_same_v<Plain, Round>) {
    members(archive, item.active, item.iterations, item.bound, item.worst, item.violation);
  } else if constexpr (std::is_same_v<Plain, Optimum>) {
    members(archive, item.outcome, item.reason, item.trade_off, item.parameters, item.objective,
            item.certificate_gap, item.kkt_residual, item.violation, item.path_bound, item.constant_objective,
            item.constant, item.peaks, item.limits, item.rounds, item.iterations, item.seen.cells,
            item.seen.share, item.seen.polished, item.ends.least, item.ends.objective_at_least,
            item.ends.most, item.ends.objective_at_most, item.orbits, item.gradients);
  } else {
    archive.take(item);
  }
}

}  // namespace

void encode(const std::vector<Optimum>& optima, engine::Bytes& out) {
  Writing(out).take(optima);
}

std::vector<Optimum> decode_optima(std::span<const std::byte> bytes) {
  std::vector<Optimum> optima;
  Reading reading(bytes);
  reading.take(optima);
  if (!reading.at_end()) throw engine::BadEntry("the record of a start is longer than its header says");
  return optima;
}

}  // namespace frahm::studies

#pragma once

#include <span>
#include <vector>

#include "engine/bytes.hpp"
#include "solvers/tuning/optimum.hpp"

// The entry of one start of a tuning in the shard logs: its optima, to the last bit.
namespace frahm::studies {

// Appends the entry to `out`.
void encode(const std::vector<tuning::Optimum>& optima, engine::Bytes& out);

// Throws engine::BadEntry for bytes not written by encode().
std::vector<tuning::Optimum> decode_optima(std::span<const std::byte> bytes);

}  // namespace frahm::studies

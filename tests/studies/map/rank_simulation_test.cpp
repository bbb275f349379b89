#include "studies/map/rank_simulation.hpp"

#include <catch2/catch.hpp>
#include <chrono>

namespace rank_simulation_test {
namespace {

using namespace frahm::studies;

constexpr double rounding = 1e-9;

// Nothing but the tiles costs anything.
RankCosts only(std::vector<CostRun> tiles) {
  return {.tiles = std::move(tiles), .start = 0.0, .assembly = 0.0, .service = 0.0, .answer = 0.0};
}

double shares(const RankPrediction& p) {
  return p.efficiency + p.start + p.waiting + p.imbalance + p.assembly;
}

TEST_CASE("one rank of one thread loses nothing but start and assembly") {
  const auto alone = simulate_ranks(only({{1000, 0.01}, {500, 0.03}}), 1, 1);
  CHECK(alone.wall == Approx(25.0).epsilon(rounding));
  CHECK(alone.efficiency == Approx(1.0).epsilon(rounding));
  RankCosts costs = only({{1000, 0.01}});
  costs.start = 2.0;
  costs.assembly = 3.0;
  const auto with_ends = simulate_ranks(costs, 1, 1);
  CHECK(with_ends.wall == Approx(15.0).epsilon(rounding));
  CHECK(with_ends.start == Approx(2.0 / 15.0).epsilon(rounding));
  CHECK(with_ends.assembly == Approx(3.0 / 15.0).epsilon(rounding));
  CHECK(with_ends.efficiency == Approx(10.0 / 15.0).epsilon(rounding));
}

TEST_CASE("the file is assembled by the ranks on the machine of rank 0, as far as one writer follows") {
  RankCosts costs = only({{1000, 0.01}});
  costs.assembly = 3.0;
  costs.processors = 8;
  CHECK(simulate_ranks(costs, 1, 1).assembly == Approx(3.0 / 13.0).epsilon(rounding));
  const auto ten = simulate_ranks(costs, 10, 2);  // four ranks of two threads there
  CHECK(ten.wall == Approx(0.5 + 3.0 / 8.0).epsilon(0.02));
  CHECK(assembling_threads(8, 10, 2) == 8);
  CHECK(assembling_threads(8, 3, 2) == 6);
  CHECK(assembling_threads(2, 10, 4) == 4);
  CHECK(assembling_threads(128, 100, 1) == 12);
}

TEST_CASE("equal tiles that divide evenly keep all ranks busy to the end") {
  const auto four = simulate_ranks(only({{4000, 0.5}}), 4, 1);
  CHECK(four.wall == Approx(500.0).epsilon(rounding));
  CHECK(four.efficiency == Approx(1.0).epsilon(rounding));
  CHECK(four.imbalance == Approx(0.0).margin(rounding));
  // The last blocks do not divide evenly among the threads of a rank: at most a tile more.
  const auto hybrid = simulate_ranks(only({{4000, 0.5}}), 2, 4);
  CHECK(hybrid.wall >= 250.0 - rounding);
  CHECK(hybrid.wall <= 250.5 + rounding);
}

TEST_CASE("one very long tile at the end is waited for by all others") {
  // 99 tiles of 1 s and one of 100 s on 4 ranks: 25 s, 25 s, 25 s and 24 + 100 s.
  const auto late = simulate_ranks(only({{99, 1.0}, {1, 100.0}}), 4, 1);
  CHECK(late.wall == Approx(124.0).epsilon(rounding));
  CHECK(late.efficiency == Approx(199.0 / (4.0 * 124.0)).epsilon(rounding));
  CHECK(late.imbalance == Approx(3.0 * 99.0 / (4.0 * 124.0)).epsilon(rounding));
}

TEST_CASE("two ranks and three tiles, by hand") {
  // Blocks of one tile. Rank 0 is served first, at 1, and computes from 1 to 11; rank 1 at 2, has its answer
  // at 5 and computes from 5 to 15. Rank 0 asked again when it had taken its tile, at 1: it is served at 3,
  // behind rank 1, and has the third tile at once when it is free: from 11 to 21. All ends at 21: 30 of 42
  // core seconds.
  const RankCosts costs{.tiles = {{3, 10.0}}, .start = 0.0, .assembly = 0.0, .service = 1.0, .answer = 3.0};
  const auto found = simulate_ranks(costs, 2, 1);
  CHECK(found.wall == Approx(21.0).epsilon(rounding));
  CHECK(found.efficiency == Approx(30.0 / 42.0).epsilon(rounding));
  CHECK(found.waiting == Approx((1.0 + 5.0) / 42.0).epsilon(rounding));
  CHECK(found.imbalance == Approx(6.0 / 42.0).epsilon(rounding));
  CHECK(found.requests == 3);
}

TEST_CASE("a rank 0 that cannot keep up is what the others wait for") {
  RankCosts costs = only({{100'000, 1e-4}});
  costs.service = 1.0;
  const auto found = simulate_ranks(costs, 100, 1);
  CHECK(found.waiting > 0.9);
  CHECK(found.wall >= static_cast<double>(found.requests) * costs.service);
  CHECK(shares(found) == Approx(1.0).epsilon(rounding));
}

TEST_CASE("efficiency and losses make one, whatever the costs") {
  const RankCosts costs{.tiles = {{317, 0.02}, {5, 1.5}, {1001, 0.003}}, .start = 0.1, .assembly = 2.0};
  for (const int ranks : {1, 2, 7, 100, 1000}) {
    for (const int threads : {1, 3, 16}) {
      INFO(ranks << " x " << threads);
      CHECK(shares(simulate_ranks(costs, ranks, threads)) == Approx(1.0).epsilon(rounding));
    }
  }
}

TEST_CASE("tiles beside a sampled one take its cost, and none is left out") {
  const auto runs = costs_of_all({{90, 3.0}, {10, 1.0}, {20, 2.0}}, 100);
  REQUIRE(runs.size() == 3);
  CHECK(runs[0].tiles == 16);  // 0 to 15
  CHECK(runs[0].seconds == 1.0);
  CHECK(runs[1].tiles == 40);  // 16 to 55
  CHECK(runs[1].seconds == 2.0);
  CHECK(runs[2].tiles == 44);
  CHECK(runs[2].seconds == 3.0);
  CHECK(costs_of_all({{0, 1.0}}, 7).front().tiles == 7);
}

TEST_CASE("the number of ranks at which efficiency falls is found") {
  RankCosts costs = only({{1'000'000, 0.01}});
  costs.assembly = 10.0;  // 10^4 s of tiles: the assembly costs a tenth at 111 ranks
  const int ranks = ranks_with_efficiency(costs, 1, 0.9, 1000);
  CHECK(ranks >= 105);
  CHECK(ranks <= 112);
  CHECK(simulate_ranks(costs, ranks, 1).efficiency >= 0.9);
  CHECK(simulate_ranks(costs, ranks + 1, 1).efficiency < 0.9);
  CHECK(ranks_with_efficiency(costs, 1, 0.9, 50) == 50);
  costs.start = 1e5;
  CHECK(ranks_with_efficiency(costs, 1, 0.9, 50) == 0);
}

TEST_CASE("ten million tiles on a thousand ranks take seconds to simulate") {
  constexpr double most_seconds = 30.0;  // a second or so on an idle machine
  const auto start = std::chrono::steady_clock::now();
  const auto found = simulate_ranks({.tiles = {{10'000'000, 0.02}}, .start = 0.1, .assembly = 0.0}, 1000, 1);
  CHECK(found.efficiency > 0.9);
  CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < most_seconds);
}

}  // namespace
}  // namespace rank_simulation_test

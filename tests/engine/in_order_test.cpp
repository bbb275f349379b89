#include "engine/in_order.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace in_order_test {
using namespace frahm::engine;

namespace {

using namespace std::chrono_literals;

const std::function<bool()> never = [] { return false; };

std::vector<std::uint64_t> first(std::uint64_t pieces) {
  std::vector<std::uint64_t> numbers(pieces);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

TEST_CASE("pieces have their turn in order and one at a time, however long each takes") {
  for (const int threads : {1, 2, 5}) {
    constexpr std::uint64_t pieces = 200;
    std::vector<std::uint64_t> order;
    std::atomic<int> at_once = 0, most_at_once = 0;
    const PieceWork work = [&](std::uint64_t piece) {
      if (piece % 7 == 0) std::this_thread::sleep_for(1ms);
      return [&, piece] {
        most_at_once = std::max<int>(most_at_once, ++at_once);
        order.push_back(piece);
        --at_once;
      };
    };
    INFO(threads << " threads");
    CHECK(make_in_order(
        threads, pieces, [&] { return work; }, never));
    CHECK(order == first(pieces));
    CHECK(most_at_once == 1);
  }
}

TEST_CASE("each thread has a workspace of its own, and no more threads are there than pieces") {
  std::atomic<int> workspaces = 0;
  std::vector<int> of_piece;
  const auto make_work = [&]() -> PieceWork {
    return [&, workspace = workspaces++](std::uint64_t) {
      return [&of_piece, workspace] { of_piece.push_back(workspace); };
    };
  };
  CHECK(make_in_order(4, 3, make_work, never));
  CHECK(workspaces == 3);
  CHECK(of_piece.size() == 3);
}

TEST_CASE("no piece is more than a few ahead of the slowest one") {
  constexpr int threads = 3;
  constexpr std::uint64_t pieces = 100;
  std::atomic<std::uint64_t> made = 0;
  std::uint64_t made_before_first_turn = 0;
  const PieceWork work = [&](std::uint64_t piece) {
    if (piece == 0) std::this_thread::sleep_for(100ms);  // the others could make all the rest meanwhile
    ++made;
    return [&, piece] {
      if (piece == 0) made_before_first_turn = made;
    };
  };
  CHECK(make_in_order(
      threads, pieces, [&] { return work; }, never));
  CHECK(made == pieces);
  CHECK(made_before_first_turn > threads);
  CHECK(made_before_first_turn <= threads * most_pieces_a_thread);
}

TEST_CASE("asked to stop, the first pieces have had their turn and the rest never will") {
  std::atomic<bool> stop = false;
  std::vector<std::uint64_t> order;
  const PieceWork work = [&](std::uint64_t piece) {
    return [&, piece] {
      order.push_back(piece);
      if (piece == 20) stop = true;
    };
  };
  CHECK_FALSE(make_in_order(
      3, 1000, [&] { return work; }, [&] { return stop.load(); }));
  CHECK(order.size() >= 21);
  CHECK(order.size() < 100);
  CHECK(order == first(order.size()));
}

TEST_CASE("an exception of a piece, or of a turn, ends the team and comes back") {
  for (const bool in_turn : {false, true}) {
    for (const int threads : {1, 4}) {
      std::uint64_t turns = 0;
      const PieceWork work = [&](std::uint64_t piece) {
        if (!in_turn && piece == 50) throw std::domain_error("made wrong");
        return [&, piece] {
          if (in_turn && piece == 50) throw std::domain_error("used wrong");
          ++turns;
        };
      };
      INFO((in_turn ? "in turn, " : "making, ") << threads << " threads");
      CHECK_THROWS_AS(make_in_order(
                          threads, 1000, [&] { return work; }, never),
                      std::domain_error);
      CHECK(turns <= 50);
    }
  }
}

TEST_CASE("an exception while others wait for the slow piece that throws it leaves none waiting") {
  const PieceWork work = [](std::uint64_t piece) -> std::function<void()> {
    if (piece > 0) return [] {};
    std::this_thread::sleep_for(50ms);
    throw std::domain_error("the piece all wait for");
  };
  CHECK_THROWS_AS(make_in_order(
                      4, 1000, [&] { return work; }, never),
                  std::domain_error);
}

TEST_CASE("a workspace that cannot be made is an error, and no pieces are no work") {
  const auto broken = []() -> PieceWork { throw std::domain_error("no workspace"); };
  CHECK_THROWS_AS(make_in_order(2, 10, broken, never), std::domain_error);
  CHECK(make_in_order(
      2, 0, [] { return PieceWork(); }, never));
}
}  // namespace in_order_test

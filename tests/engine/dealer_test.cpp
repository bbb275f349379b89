#include "engine/dealer.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <numeric>
#include <set>

namespace dealer_test {
using namespace frahm::engine;
using Catch::Matchers::Contains;
using Kind = RankMessage::Kind;

namespace {

// Rank 0 among others that say what the test says.
class ScriptedRanks : public Ranks {
 public:
  explicit ScriptedRanks(int size) : size_(size) {}
  int rank() const override { return 0; }
  int size() const override { return size_; }
  int processors() const override { return 1; }
  int take_machine() override { return 1; }
  void send(int to, const Bytes& message) override { sent_[to].push_back(decode(message)); }
  std::optional<Message> receive() override {
    if (coming_.empty()) return std::nullopt;
    Message message = std::move(coming_.front());
    coming_.pop_front();
    return message;
  }

  void give_up(int rank) override { given_up_.insert(rank); }
  void take_back(int rank) override { given_up_.erase(rank); }
  void end_without_given_up(int) override {}
  const std::set<int>& given_up() const { return given_up_; }

  void say(int from, const RankMessage& message) { coming_.push_back({from, encode(message)}); }
  // What rank 0 has told a rank since this was asked last.
  std::vector<RankMessage> told(int rank) { return std::exchange(sent_[rank], {}); }

 private:
  int size_;
  std::deque<Message> coming_;
  std::map<int, std::vector<RankMessage>> sent_;
  std::set<int> given_up_;
};

// No rank of the test is silent for so long.
const Silence patient{.longest = std::chrono::hours(1), .salvage = {}};

constexpr std::uint64_t mark = 77;

std::vector<std::uint64_t> numbers(std::uint64_t count) {
  std::vector<std::uint64_t> tiles(count);
  std::iota(tiles.begin(), tiles.end(), 1000);
  return tiles;
}

std::vector<std::uint64_t> empty(TileQueue& queue) {
  std::vector<std::uint64_t> tiles;
  while (!queue.is_empty()) tiles.push_back(*queue.take());
  return tiles;
}

RankMessage ready(std::uint64_t threads) {
  return {.kind = Kind::ready, .threads = threads, .text = "process 4711 on node17"};
}

}  // namespace

TEST_CASE("a message between ranks comes as it was sent") {
  const RankMessage sent{
      .kind = Kind::leave,
      .threads = 3,
      .study = ~std::uint64_t{0},
      .code = 6,
      .finished = {.tiles = 1, .points = 2, .reused = 5, .failed = 3, .cpu_milliseconds = 4},
      .tiles = {9, 8, 7},
      .text = "stopped by SIGUSR1"};
  const RankMessage come = decode(encode(sent));
  CHECK(come.kind == sent.kind);
  CHECK(come.threads == 3);
  CHECK(come.study == sent.study);
  CHECK(come.code == 6);
  CHECK(come.finished.tiles == 1);
  CHECK(come.finished.points == 2);
  CHECK(come.finished.reused == 5);
  CHECK(come.finished.failed == 3);
  CHECK(come.finished.cpu_milliseconds == 4);
  CHECK(come.tiles == sent.tiles);
  CHECK(come.text == sent.text);
  CHECK(decode(encode({})).text.empty());
}

TEST_CASE("every tile is dealt out once, in order, in blocks that shrink to single ones") {
  ScriptedRanks ranks(3);
  TileQueue own;
  Dealer dealer(ranks, mark, 2, numbers(500), own, patient);
  ranks.say(1, ready(4));
  ranks.say(2, ready(1));
  dealer.serve(false);
  CHECK(ranks.told(1).at(0).kind == Kind::begin);
  CHECK(ranks.told(2).at(0).study == mark);

  std::vector<std::uint64_t> dealt;
  std::size_t first = 0, last = 0;
  for (bool open = true; open;) {
    const auto mine = empty(own);
    ranks.say(1, {.kind = Kind::ask});
    ranks.say(2, {.kind = Kind::ask});
    dealer.serve(false);
    dealt.insert(dealt.end(), mine.begin(), mine.end());
    open = false;
    for (const int rank : {1, 2}) {
      const RankMessage answer = ranks.told(rank).at(0);
      CHECK((answer.kind == Kind::deal) == !answer.tiles.empty());
      CHECK((answer.kind == Kind::deal || answer.kind == Kind::close));
      dealt.insert(dealt.end(), answer.tiles.begin(), answer.tiles.end());
      if (answer.tiles.empty()) continue;
      open = true;
      if (first == 0) first = answer.tiles.size();
      last = answer.tiles.size();
    }
  }
  const auto rest = empty(own);
  dealt.insert(dealt.end(), rest.begin(), rest.end());
  std::sort(dealt.begin(), dealt.end());
  CHECK(dealt == numbers(500));
  CHECK(first > 10);
  CHECK(last == 1);
  CHECK(dealer.threads() == 7);

  CHECK_FALSE(dealer.all_have_left());
  ranks.say(1, {.kind = Kind::leave, .finished = {.tiles = 5, .points = 50}});
  ranks.say(2, {.kind = Kind::leave, .finished = {.tiles = 7, .points = 70, .failed = 2}});
  dealer.serve(false);
  CHECK(dealer.all_have_left());
  CHECK_FALSE(own.take());  // closed
  CHECK(dealer.finished().tiles == 12);
  CHECK(dealer.finished().points == 120);
  CHECK(dealer.finished().failed == 2);
  CHECK(dealer.stop_reason().empty());
  CHECK_NOTHROW(dealer.rethrow_failure());
}

TEST_CASE("asked to stop, rank 0 deals no more and tells the ranks at work, also one that comes late") {
  ScriptedRanks ranks(3);
  TileQueue own;
  Dealer dealer(ranks, mark, 1, numbers(100), own, patient);
  ranks.say(1, ready(1));
  dealer.serve(false);
  ranks.told(1);
  CHECK_FALSE(own.is_empty());
  dealer.serve(true);
  CHECK(own.is_empty());
  CHECK_FALSE(own.take());
  CHECK(ranks.told(1).at(0).kind == Kind::stop);

  ranks.say(1, {.kind = Kind::ask});  // was on its way
  ranks.say(2, ready(1));
  dealer.serve(true);
  CHECK(ranks.told(1).empty());
  CHECK(ranks.told(2).at(0).kind == Kind::stop);
  ranks.say(1, {.kind = Kind::leave});
  ranks.say(2, {.kind = Kind::leave});
  dealer.serve(true);
  CHECK(dealer.all_have_left());
}

TEST_CASE("a rank that is stopped by a signal stops all, and is named as the reason") {
  ScriptedRanks ranks(3);
  TileQueue own;
  Dealer dealer(ranks, mark, 1, numbers(100), own, patient);
  ranks.say(1, ready(1));
  ranks.say(2, ready(1));
  dealer.serve(false);
  ranks.told(2);
  ranks.say(1, {.kind = Kind::leave, .text = "stopped by SIGUSR1"});
  dealer.serve(false);
  CHECK(ranks.told(2).at(0).kind == Kind::stop);
  CHECK(own.is_empty());
  CHECK(dealer.stop_reason() == "stopped by SIGUSR1");
  ranks.say(2, {.kind = Kind::leave});
  dealer.serve(false);
  CHECK(dealer.all_have_left());
}

TEST_CASE("a rank that fails stops all, and its error is thrown with its name and code") {
  ScriptedRanks ranks(3);
  TileQueue own;
  Dealer dealer(ranks, mark, 1, numbers(100), own, patient);
  ranks.say(2, ready(1));
  ranks.say(1, {.kind = Kind::fail, .code = 2, .text = "no study"});  // before it was ready
  ranks.say(2, {.kind = Kind::fail, .code = 6, .text = "disk full"});
  dealer.serve(false);
  CHECK(dealer.all_have_left());
  CHECK(own.is_empty());
  CHECK_THROWS_WITH(dealer.rethrow_failure(), "rank 1: no study");
  try {
    dealer.rethrow_failure();
  } catch (const RankFailed& failure) {
    CHECK(failure.code() == 2);
  }
}

TEST_CASE("the error of a rank at work names its process and machine") {
  ScriptedRanks ranks(2);
  TileQueue own;
  Dealer dealer(ranks, mark, 1, numbers(3), own, patient);
  ranks.say(1, ready(1));
  ranks.say(1, {.kind = Kind::fail, .code = 6, .text = "disk full"});
  dealer.serve(false);
  CHECK_THROWS_WITH(dealer.rethrow_failure(), "rank 1 (process 4711 on node17): disk full");
}

TEST_CASE("with nothing to compute all ranks are sent home at once") {
  ScriptedRanks ranks(2);
  TileQueue own;
  Dealer dealer(ranks, mark, 1, {}, own, patient);
  ranks.say(1, ready(8));
  ranks.say(1, {.kind = Kind::ask});
  ranks.say(1, {.kind = Kind::leave});
  dealer.serve(false);
  CHECK_FALSE(own.take());
  const auto told = ranks.told(1);
  REQUIRE(told.size() == 2);
  CHECK(told[1].kind == Kind::close);
}

namespace {

// A rank is dealt tiles, has finished the first one when it falls silent, and rank 0 looks at the times
// given.
struct Frozen {
  ScriptedRanks ranks{3};
  TileQueue own;
  std::vector<std::uint64_t> dealt = {};  // to rank 1
  Silence silence{.longest = std::chrono::seconds(10), .salvage = [this](int rank, const auto& tiles) {
                    CHECK(rank == 1);
                    CHECK(tiles == dealt);
                    return Salvage{.missing = {tiles.begin() + 1, tiles.end()},
                                   .finished = {.tiles = 1, .points = 10, .failed = 2}};
                  }};
  Dealer dealer{ranks, mark, 1, numbers(100), own, silence};
  Dealer::Clock::time_point now = Dealer::Clock::now();

  Frozen() {
    ranks.say(1, ready(1));
    ranks.say(2, ready(1));
    ranks.say(1, {.kind = Kind::ask});
    dealer.serve(false, now);
    dealt = ranks.told(1).at(1).tiles;
    REQUIRE(dealt.size() > 2);
  }
  // Rank 2 goes on speaking.
  void pass(int seconds) {
    for (int second = 0; second < seconds; ++second) {
      ranks.say(2, {.kind = Kind::tell});
      dealer.serve(false, now += std::chrono::seconds(1));
    }
  }
};

}  // namespace

TEST_CASE("a rank that is silent for too long is given up, and what its log lacks is dealt out again") {
  Frozen job;
  job.pass(10);
  CHECK(job.ranks.given_up().empty());
  CHECK(job.dealer.take_notices().empty());
  job.pass(1);
  CHECK(job.ranks.given_up() == std::set<int>{1});
  CHECK(job.dealer.finished().points == 10);
  CHECK(job.dealer.finished().failed == 2);
  const auto notices = job.dealer.take_notices();
  REQUIRE(notices.size() == 1);
  CHECK_THAT(notices[0], Contains("rank 1 (process 4711 on node17)") && Contains("10 s"));

  std::vector<std::uint64_t> rest = empty(job.own);
  for (bool open = true; open;) {
    job.ranks.told(2);
    job.ranks.say(2, {.kind = Kind::ask});
    job.dealer.serve(false, job.now);
    const RankMessage answer = job.ranks.told(2).at(0);
    open = answer.kind == Kind::deal;
    rest.insert(rest.end(), answer.tiles.begin(), answer.tiles.end());
    const auto mine = empty(job.own);
    rest.insert(rest.end(), mine.begin(), mine.end());
  }
  std::sort(rest.begin(), rest.end());
  std::vector<std::uint64_t> others = numbers(100);
  std::erase(others, job.dealt.front());
  CHECK(rest == others);
  CHECK_FALSE(job.dealer.all_have_left());
  job.ranks.say(2, {.kind = Kind::leave});
  job.dealer.serve(false, job.now);
  CHECK(job.dealer.all_have_left());
  CHECK_FALSE(job.own.take());
}

TEST_CASE("a rank that thaws after it was given up is sent home, and its counts do not count") {
  Frozen job;
  job.pass(11);
  job.ranks.say(1, {.kind = Kind::tell, .finished = {.tiles = 3, .points = 30}});
  job.dealer.serve(false, job.now);
  CHECK(job.ranks.told(1).at(0).kind == Kind::stop);
  job.ranks.say(1,
                {.kind = Kind::leave, .finished = {.tiles = 3, .points = 30}, .text = "stopped by SIGTERM"});
  job.dealer.serve(false, job.now);
  CHECK(job.ranks.given_up().empty());
  CHECK(job.dealer.finished().points == 10);
  CHECK(job.dealer.stop_reason().empty());
}

TEST_CASE("the time in which rank 0 was frozen itself is no silence of the others") {
  Frozen job;
  job.dealer.serve(false, job.now += std::chrono::hours(1));
  CHECK(job.ranks.given_up().empty());
}

TEST_CASE("a rank that never came is given up too") {
  ScriptedRanks ranks(2);
  TileQueue own;
  const auto nothing = [](int, const auto& tiles) {
    CHECK(tiles.empty());
    return Salvage{};
  };
  Dealer dealer(ranks, mark, 1, numbers(3), own, {.longest = std::chrono::seconds(1), .salvage = nothing});
  auto now = Dealer::Clock::now();
  std::vector<std::uint64_t> mine;
  for (int second = 0; second < 4; ++second) {
    dealer.serve(false, now += std::chrono::seconds(1));
    for (const std::uint64_t tile : empty(own)) mine.push_back(tile);
  }
  CHECK(dealer.all_have_left());
  CHECK(mine == numbers(3));
}
}  // namespace dealer_test

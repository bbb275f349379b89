#include "engine/dealer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/handout.hpp"

namespace frahm::engine {
namespace {

using Kind = RankMessage::Kind;

}  // namespace

Dealer::Dealer(Ranks& ranks, std::uint64_t study, int threads, std::vector<std::uint64_t> tiles,
               TileQueue& own, Silence silence)
    : ranks_(ranks),
      study_(study),
      tiles_(std::move(tiles)),
      own_(own),
      silence_(std::move(silence)),
      present_(ranks.size() - 1),
      members_(static_cast<std::size_t>(ranks.size())) {
  members_.front() = {.name = "rank 0", .threads = threads, .at_work = true};
}

void Dealer::serve(bool stop_asked, Clock::time_point now) {
  pass_time(now);
  if (stop_asked) stop();
  while (const auto message = ranks_.receive()) answer(message->from, decode(message->bytes));
  give_up_silent();
  fill_own();
}

void Dealer::pass_time(Clock::time_point now) {
  constexpr std::chrono::duration<double> longest_step(1.0);
  const std::chrono::duration<double> step = now - served_.value_or(now);
  awake_ += std::min(step, longest_step);
  served_ = now;
}

void Dealer::answer(int rank, const RankMessage& message) {
  Member& member = members_[static_cast<std::size_t>(rank)];
  if (member.is_given_up) return answer_late(rank, message);
  member.heard = awake_;
  {
    const std::lock_guard turn(turn_);
    if (message.kind == Kind::ask || message.kind == Kind::tell || message.kind == Kind::leave)
      member.finished = message.finished;
    if (message.kind == Kind::leave) {
      leave(member);
      if (stop_reason_.empty()) stop_reason_ = message.text;
    }
    if (message.kind == Kind::fail) {
      leave(member);
      const std::string name = member.name.empty() ? fmt::format("rank {}", rank) : member.name;
      if (!failure_)
        failure_.emplace(fmt::format("{}: {}", name, message.text), static_cast<int>(message.code));
    }
  }
  if (message.kind == Kind::ready) welcome(rank, message);
  if (message.kind == Kind::ask) deal_to(rank);
  if (message.kind == Kind::fail || (message.kind == Kind::leave && !message.text.empty())) stop();
}

// It was only slow, or is thawed. Its tiles are computed by others; it may go.
void Dealer::answer_late(int rank, const RankMessage& message) {
  if (message.kind == Kind::ready || message.kind == Kind::ask || message.kind == Kind::tell)
    ranks_.send(rank, encode({.kind = Kind::stop}));
  else
    ranks_.take_back(rank);
}

void Dealer::give_up_silent() {
  for (std::size_t rank = 1; rank < members_.size(); ++rank) {
    const Member& member = members_[rank];
    if (!member.has_left && awake_ - member.heard > silence_.longest) give_up(static_cast<int>(rank));
  }
}

void Dealer::give_up(int rank) {
  Member& member = members_[static_cast<std::size_t>(rank)];
  ranks_.give_up(rank);
  Salvage left = silence_.salvage(rank, member.tiles);
  const std::lock_guard turn(turn_);
  leave(member);
  member.is_given_up = true;
  member.finished.tiles = left.finished.tiles;
  member.finished.points = left.finished.points;
  member.finished.failed = left.finished.failed;
  if (!stopping_) tiles_.insert(tiles_.end(), left.missing.begin(), left.missing.end());
  notices_.push_back(fmt::format(
      "{} has been silent for {:.0f} s and is no longer waited for; {} of its {} tiles are given out again",
      member.name.empty() ? fmt::format("rank {}", rank) : member.name, silence_.longest.count(),
      left.missing.size(), member.tiles.size()));
}

std::vector<std::string> Dealer::take_notices() {
  const std::lock_guard turn(turn_);
  return std::exchange(notices_, {});
}

void Dealer::leave(Member& member) {
  if (!std::exchange(member.has_left, true)) --present_;
  member.at_work = false;
}

void Dealer::welcome(int rank, const RankMessage& message) {
  const std::lock_guard turn(turn_);
  Member& member = members_[static_cast<std::size_t>(rank)];
  member.name = fmt::format("rank {} ({})", rank, message.text);
  member.threads = static_cast<int>(message.threads);
  member.at_work = !stopping_;
  ranks_.send(rank, encode({.kind = member.at_work ? Kind::begin : Kind::stop, .study = study_}));
}

void Dealer::deal_to(int rank) {
  if (stopping_) return;  // the rank has its `stop`
  std::vector<std::uint64_t> block;
  {
    const std::lock_guard turn(turn_);
    block = take_block(members_[static_cast<std::size_t>(rank)]);
  }
  const Kind kind = block.empty() ? Kind::close : Kind::deal;
  ranks_.send(rank, encode({.kind = kind, .tiles = std::move(block)}));
}

void Dealer::fill_own() {
  if (own_is_closed_ || !own_.is_empty()) return;
  std::vector<std::uint64_t> block;
  {
    const std::lock_guard turn(turn_);
    block = take_block(members_.front());
  }
  own_.add(block);
  own_is_closed_ = block.empty() && all_have_left();
  if (own_is_closed_) own_.close();
}

void Dealer::stop() {
  if (std::exchange(stopping_, true)) return;
  next_ = tiles_.size();
  own_.drop();
  own_is_closed_ = true;
  const std::lock_guard turn(turn_);
  for (std::size_t rank = 1; rank < members_.size(); ++rank) {
    if (members_[rank].at_work) ranks_.send(static_cast<int>(rank), encode({.kind = Kind::stop}));
  }
}

// The next tiles for a rank; none when all are dealt out.
std::vector<std::uint64_t> Dealer::take_block(Member& member) {
  const std::size_t left = tiles_.size() - next_;
  if (left == 0) return {};
  const auto begin = tiles_.begin() + static_cast<std::ptrdiff_t>(next_);
  const std::size_t size = block_size(left, member.threads, expected_threads());
  const auto end = begin + static_cast<std::ptrdiff_t>(size);
  next_ += size;
  member.tiles.insert(member.tiles.end(), begin, end);
  return {begin, end};
}

// Ranks without a message yet are assumed to have as many threads as rank 0.
int Dealer::expected_threads() const {
  int all = 0;
  for (const Member& member : members_) all += member.threads > 0 ? member.threads : members_.front().threads;
  return all;
}

Finished Dealer::finished() const {
  const std::lock_guard turn(turn_);
  Finished all;
  for (const Member& member : members_) all += member.finished;
  return all;
}

int Dealer::threads() const {
  const std::lock_guard turn(turn_);
  int all = 0;
  for (const Member& member : members_) all += member.threads;
  return all;
}

std::string Dealer::stop_reason() const {
  const std::lock_guard turn(turn_);
  return stop_reason_;
}

void Dealer::rethrow_failure() const {
  const std::lock_guard turn(turn_);
  if (failure_) throw *failure_;
}

}  // namespace frahm::engine

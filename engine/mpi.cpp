#include "engine/mpi.hpp"

#ifdef FRAHM_MPI

#include <mpi.h>
#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <list>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace frahm::engine {
namespace {

// Whether the environment has a variable set by the launchers of the usual implementations. MPI is not
// started without a launcher: its start would slow every short command, and some clusters forbid it on their
// login nodes.
bool is_launched_by_mpi() {
  constexpr std::array launchers{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "MV2_COMM_WORLD_SIZE"};
  return std::any_of(launchers.begin(), launchers.end(), [](const char* name) { return std::getenv(name); });
}

cpu_set_t own_mask() {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  ::sched_getaffinity(0, sizeof mask, &mask);
  return mask;
}

// The processors that each rank of this machine may use, this process among them.
std::vector<cpu_set_t> masks_of_machine() {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int ranks = 1;
  MPI_Comm_size(machine, &ranks);
  const cpu_set_t own = own_mask();
  std::vector<cpu_set_t> masks(static_cast<std::size_t>(ranks));
  MPI_Allgather(&own, sizeof own, MPI_BYTE, masks.data(), sizeof own, MPI_BYTE, machine);
  MPI_Comm_free(&machine);
  return masks;
}

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED)
      throw std::runtime_error("this MPI lets only the main thread send messages (MPI_THREAD_SERIALIZED)");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    machine_ = masks_of_machine();
  }
  ~MpiRanks() override {
    for (Sending& sending : sendings_) MPI_Wait(&sending.request, MPI_STATUS_IGNORE);
    MPI_Finalize();
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  int processors() const override {
    const cpu_set_t own = own_mask();
    const auto sharing = std::count_if(machine_.begin(), machine_.end(),
                                       [&](const cpu_set_t& other) { return CPU_EQUAL(&own, &other) != 0; });
    return std::max(1, omp_get_num_procs() / std::max(1, static_cast<int>(sharing)));
  }

  int take_machine() override {
    cpu_set_t all = own_mask();
    for (const cpu_set_t& mask : machine_) CPU_OR(&all, &all, &mask);
    ::sched_setaffinity(0, sizeof all, &all);  // if not allowed, its own processors must do
    return static_cast<int>(machine_.size());
  }

  void send(int to, const Bytes& message) override {
    Sending& sending = sendings_.emplace_back(message);
    MPI_Isend(sending.bytes.data(), static_cast<int>(sending.bytes.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD,
              &sending.request);
  }

  std::optional<Message> receive() override {
    forget_sent();
    int has_come = 0;
    MPI_Status status{};
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &has_come, &status);
    if (has_come == 0) return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Message message{.from = status.MPI_SOURCE, .bytes = Bytes(static_cast<std::size_t>(size))};
    MPI_Recv(message.bytes.data(), size, MPI_BYTE, message.from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }

  void give_up(int rank) override { given_up_.insert(rank); }
  void take_back(int rank) override { given_up_.erase(rank); }
  void end_without_given_up(int code) override {
    if (given_up_.empty()) return;
    std::cout.flush();
    MPI_Abort(MPI_COMM_WORLD, code);  // MPI_Finalize would wait for them
  }

 private:
  // The bytes must not move until they are sent.
  struct Sending {
    explicit Sending(const Bytes& message) : bytes(message) {}
    Bytes bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void forget_sent() {
    std::erase_if(sendings_, [](Sending& sending) {
      int sent = 0;
      MPI_Test(&sending.request, &sent, MPI_STATUS_IGNORE);
      return sent != 0;
    });
  }

  int rank_ = 0, size_ = 1;
  std::vector<cpu_set_t> machine_;  // masks_of_machine()
  std::list<Sending> sendings_;
  std::set<int> given_up_;
};

}  // namespace

std::unique_ptr<Ranks> mpi_ranks() {
  if (!is_launched_by_mpi()) return nullptr;
  auto ranks = std::make_unique<MpiRanks>();
  return ranks->size() > 1 ? std::move(ranks) : nullptr;
}

std::string mpi_library() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);  // "Open MPI v4.1.4, package: ..."
  const std::string_view version(text.data());
  return std::string(version.substr(0, version.find_first_of(",\n")));
}

}  // namespace frahm::engine

#else

namespace frahm::engine {

std::unique_ptr<Ranks> mpi_ranks() {
  return nullptr;
}
std::string mpi_library() {
  return {};
}

}  // namespace frahm::engine

#endif

#include <atomic>
#include <iostream>
#include <mutex>
#include <optional>
#include <sstream>
#include <streambuf>

#include "studies/program/run_command.hpp"
#include "studies/python/binding.hpp"
#include "studies/python/one_blas_thread.hpp"

// A run of the program inside Python.
namespace frahm::python {
namespace {

// While it exists, lines written to std::cerr, by any thread, go to a function of Python instead, which
// returns whether the run is to stop. The lines of a run alone: there is one run at a time in a process.
class LinesToPython : public std::streambuf {
 public:
  LinesToPython(py::function tell, std::atomic<bool>& called_off)
      : tell_(std::move(tell)), called_off_(called_off), before_(std::cerr.rdbuf(this)) {}
  ~LinesToPython() override { std::cerr.rdbuf(before_); }
  LinesToPython(const LinesToPython&) = delete;
  LinesToPython& operator=(const LinesToPython&) = delete;

 protected:
  int_type overflow(int_type letter) override {
    if (traits_type::eq_int_type(letter, traits_type::eof())) return traits_type::not_eof(letter);
    const char one = traits_type::to_char_type(letter);
    return xsputn(&one, 1) == 1 ? letter : traits_type::eof();
  }

  std::streamsize xsputn(const char* text, std::streamsize count) override {
    for (const std::string& line : finished_lines(text, count)) tell(line);
    return count;
  }

 private:
  std::vector<std::string> finished_lines(const char* text, std::streamsize count) {
    const std::lock_guard turn(turn_);
    std::vector<std::string> lines;
    for (std::streamsize i = 0; i < count; ++i) {
      if (text[i] == '\n')
        lines.push_back(std::exchange(line_, {}));
      else
        line_ += text[i];
    }
    return lines;
  }

  // A fault of what shows the lines, such as a terminal that is gone, is no fault of the run.
  void tell(const std::string& line) {
    const py::gil_scoped_acquire held;
    try {
      if (tell_(text_of(line)).cast<bool>()) called_off_ = true;
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("frahm: progress");
    }
  }

  py::function tell_;
  std::atomic<bool>& called_off_;
  std::mutex turn_;
  std::string line_;
  std::streambuf* before_;
};

// The only run of the process, as long as it lives.
class OnlyRun {
 public:
  OnlyRun() {
    if (under_way.exchange(true)) throw std::logic_error("a run is already under way in this process");
  }
  ~OnlyRun() { under_way = false; }
  OnlyRun(const OnlyRun&) = delete;
  OnlyRun& operator=(const OnlyRun&) = delete;

 private:
  static inline std::atomic<bool> under_way = false;
};

// Returns the exit code of the program, and what it prints to standard output.
py::tuple run(const LoadedStudy& loaded, const std::string& output, const std::string& from, int threads,
              bool fresh, std::optional<double> time_budget, const std::string& command, py::function tell) {
  studies::RunCommandOptions options{
      .study = loaded.study.source.name, .set = loaded.set, .from = from, .command = command, .run = {}};
  options.run.output = output;
  options.run.threads = threads;
  options.run.fresh = fresh;
  options.run.progress = engine::ProgressStyle::json;
  if (time_budget) options.run.time_budget = std::chrono::duration<double>(*time_budget);
  std::atomic<bool> called_off = false;
  options.run.called_off = &called_off;
  std::ostringstream out;
  int code = 0;
  {
    const OnlyRun alone;
    const LinesToPython lines(std::move(tell), called_off);
    const OneBlasThread blas;
    const py::gil_scoped_release free;
    code = studies::run_study(options, loaded.study, out);
  }
  return py::make_tuple(code, out.str());
}

}  // namespace

void add_run(py::module_& module) {
  module.def("run", run, py::arg("study"), py::arg("output"), py::arg("from_"), py::arg("threads"),
             py::arg("fresh"), py::arg("time_budget"), py::arg("command"), py::arg("tell"));
}

}  // namespace frahm::python

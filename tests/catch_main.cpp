#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <csignal>

// Tests send signals, which would stay ignored where the tests are a shell's job in the background.
int main(int count, char** arguments) {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  return Catch::Session().run(count, arguments);
}

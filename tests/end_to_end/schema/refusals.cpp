// Reads studies from the standard input, each a name and a text that end with a zero byte. Writes for each
// the key of the rule that it breaks, or "none", "schema" where the schema refuses it too or "beyond", and
// the message, in the same form.
#include <iostream>
#include <string>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

int main() {
  using namespace frahm::studies;
  std::string name, text;
  while (std::getline(std::cin, name, '\0') && std::getline(std::cin, text, '\0')) {
    try {
      parse_study(text, name);
      std::cout << "none" << '\0' << '\0' << '\0';
    } catch (const StudyError& error) {
      std::cout << error.rule().key << '\0' << (error.rule().is_in_schema ? "schema" : "beyond") << '\0'
                << error.what() << '\0';
    }
  }
}

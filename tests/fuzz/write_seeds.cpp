// Writes the seeds of traces into the folder that is named. Made anew where a format changes, they need no place in the
// repository.

#include <cstdlib>
#include <iostream>

#include "seeds.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return EXIT_FAILURE;
  }
  tribofit::fuzz::write_seeds(argv[1]);
  return EXIT_SUCCESS;
}

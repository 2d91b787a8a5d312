// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>

#include "tests/evaluation/reference_results.h"

// print_reference_comparison FOLDER: every statistic of reference-results.txt, evo's value and ours, and at the end how
// many agree to the printed digits; exit 1 where one does not.
int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER-OF-reference-results.txt\n", argv[0]);
    return 2;
  }
  int agreeing = 0, total = 0;
  for (const alidade::ReferenceCase& reference : alidade::read_reference_cases(argv[1])) {
    std::printf("%s\n", reference.command.c_str());
    for (const alidade::ReferenceValue& value : alidade::compare(reference)) {
      const bool same = value.evo == value.ours;
      std::printf("  %-6s  evo %12s  ours %12s%s\n", value.statistic.c_str(), value.evo.c_str(), value.ours.c_str(),
                  same ? "" : "  DIFFERS");
      agreeing += same;
      ++total;
    }
  }
  std::printf("%d of %d values agree to the printed digits\n", agreeing, total);
  return agreeing == total && total > 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

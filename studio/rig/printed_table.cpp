#include "studio/rig/printed_table.h"

#include <map>

#include "core/model/result.h"

namespace ctpm::rig {

const std::vector<PrintedRow>& printed_table(const std::string& organ) {
  static const std::map<std::string, std::vector<PrintedRow>> kPrinted{{"skin",
                                                                        {{2, 0.37, 1.6, 1.7},
                                                                         {4, 1.47, 3.9, 3.6},
                                                                         {6, 3.3, 6.1, 5.7},
                                                                         {8, 5.8, 9.2, 7.7},
                                                                         {10, 8.9, 12.3, 9.9},
                                                                         {12, 12.6, 15.8, 12.3}}},
                                                                       {"kidney",
                                                                        {{2, 0.73, 0.42, 0.37},
                                                                         {4, 2.9, 0.8, 0.7},
                                                                         {6, 6.3, 1.5, 1.2},
                                                                         {8, 10.8, 2.2, 1.7},
                                                                         {10, 16.3, 3.2, 2.3},
                                                                         {12, 22.4, 4.5, 3.0}}},
                                                                       {"liver",
                                                                        {{2, 0.14, 0.19, 0.17},
                                                                         {4, 0.54, 0.4, 0.25},
                                                                         {6, 1.2, 0.66, 0.38},
                                                                         {8, 2.1, 0.96, 0.62},
                                                                         {10, 3.1, 1.3, 0.84},
                                                                         {12, 4.2, 1.8, 1.1}}}};
  const auto it = kPrinted.find(organ);
  CTPM_CHECK(it != kPrinted.end(), "the paper has skin, kidney and liver");
  return it->second;
}

}  // namespace ctpm::rig

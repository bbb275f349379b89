#include "studies/page/finish_result.hpp"

#include "studies/page/page_groups.hpp"

namespace frahm::studies {

void finish_result(results::MapWriter& writer, const StudyPlan& plan, const results::MapLayout& layout,
                   const RunFacts& run, const std::vector<std::string>& failed, std::uint64_t missing) {
  writer.write_texts("provenance", provenance(plan, run, failed, missing));
  for (const results::GroupContent& group : page_groups(plan.study, layout)) writer.write_group(group);
  writer.finish();
}

}  // namespace frahm::studies

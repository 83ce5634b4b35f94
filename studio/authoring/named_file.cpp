#include "studio/authoring/named_file.h"

#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace ctpm::authoring {
namespace {

/// The repaired meshes of all names that are asked for.
Result<importers::RepairedFile> repair(const ImportRequest& request, importers::ImportOptions options) {
  const std::size_t most = request.parts == Parts::each ? kMostOrgans : 1;
  std::optional<importers::RepairedFile> all;
  for (const std::string& name : request.names.empty() ? std::vector<std::string>{""} : request.names) {
    options.part = name;
    Result<importers::RepairedFile> one = importers::repair_file(request.mesh, options, most);
    if (!one) return one.errors();
    if (!all)
      all = *std::move(one);
    else
      std::move(one->mesh.begin(), one->mesh.end(), std::back_inserter(all->mesh));
    // One unit for all of them, as the file has one.
    options.unit_in_metres = all->report.unit.in_metres, options.size.reset(), options.scale = 1;
  }
  return *std::move(all);
}

}  // namespace

Result<NamedFile> repair_named(const ImportRequest& request, const std::string& folder,
                               importers::ImportOptions options) {
  const std::string file_name = std::filesystem::path(request.mesh).stem().string();
  Result<Tissue> tissue = choose_tissue(folder, request.organ, {file_name});
  if (!tissue) return tissue.errors();
  options.usual_size = tissue->usual_size();
  Result<importers::RepairedFile> file = repair(request, options);
  if (!file) return file.errors();
  if (!tissue->is_assumed || file->report.parts.size() != 1) return NamedFile{*std::move(tissue), *std::move(file)};
  tissue = choose_tissue(folder, "", file->report.parts);
  if (!tissue) return tissue.errors();
  const bool is_guessed = file->report.unit.source == importers::UnitSource::guessed;
  if (!tissue->is_assumed && is_guessed) {
    options.usual_size = tissue->usual_size();
    file = repair(request, options);
    if (!file) return file.errors();
  }
  return NamedFile{*std::move(tissue), *std::move(file)};
}

}  // namespace ctpm::authoring

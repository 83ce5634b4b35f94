#include "studio/commands/moment_pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studio/film/stills.h"
#include "studio/output/number_text.h"

namespace ctpm::commands {

Result<std::vector<compare::MomentPictures>> draw_moments(recordings::SessionReader& trainee,
                                                          recordings::SessionReader& expert,
                                                          const std::vector<std::array<double, 2>>& times,
                                                          bool allow_diverged) {
  if (times.empty()) return std::vector<compare::MomentPictures>();
  // Drawn in the order of time, because a replay goes forward; so does the expert along the path.
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return times[i]; });
  const double tick = trainee.start().model.tick;
  std::vector<film::StillsRequest> requests(2);
  for (const std::size_t i : order)
    for (std::size_t session = 0; session < 2; ++session)
      requests[session].ticks.push_back(std::llround(times[i][session] / tick));
  film::ExportOptions options;
  options.size = {640, 360};
  options.allow_diverged = allow_diverged;
  const auto caption = [&](std::int64_t at, const std::string&) { return output::fixed(double(at) * tick, 2) + " s"; };
  Result<std::vector<std::vector<render::Frame>>> stills =
      film::draw_stills({&trainee, &expert}, requests, caption, options);
  if (!stills) return stills.errors();
  std::vector<compare::MomentPictures> pictures(times.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    pictures[order[i]] = {std::move((*stills)[0][i]), std::move((*stills)[1][i])};
  return pictures;
}

}  // namespace ctpm::commands

#include "recordings/internal/legacy_values.h"

#include <algorithm>

#include "core/stepping/integrator.h"
#include "recordings/internal/model_check.h"

namespace ctpm::recordings::session_file {
namespace {
constexpr std::int32_t automatic = 0;

/// Text of `cut` events that mean loose pieces; their one value is the number of pieces.
constexpr const char* piece_sentence = "a piece comes loose; value: pieces";
constexpr double most_pieces = 1e9;
}  // namespace

const char* retired_integrator(std::int32_t number) {
  switch (number) {
    case automatic:
      return "automatic";
    case 1:
      return "symplectic Euler";
    case 3:
      return "extrapolated Euler";
    default:
      return nullptr;
  }
}

Result<Done> update_integrator(Model& model, std::int32_t physics_revision, std::vector<std::string>& remarks) {
  const auto stored = static_cast<std::int32_t>(model.solver.integrator);
  const char* retired = retired_integrator(stored);
  if (!retired) return Done{};
  if (stored != automatic)
    return Error{"", std::string("was recorded with ") + retired + ", which this program no longer has",
                 "use the program that recorded it"};
  if (physics_revision != 0) return Done{};  // refused as an unknown kind
  // The choice reads the whole Model, so check the Model first.
  model.solver.integrator = Integrator::backward_euler;
  if (!check_model(model).empty()) return Done{};
  const stepping::IntegratorChoice choice = stepping::resolve_integrator(model);
  remarks.push_back("the session does not store which integrator `auto` became; this build takes " +
                    std::string(stepping::name_of(choice.integrator)) + " with " + std::to_string(choice.substeps) +
                    (choice.substeps == 1 ? " substep" : " substeps") + " a tick");
  return Done{};
}

void give_modulus(Model& model) {
  constexpr double kYoungOverEdge = 2.5;  // of k / s, network::LatticeKind::cubic_18
  for (OrganRange& organ : model.organs) {
    if (organ.modulus != 0 || !(organ.spacing > 0)) continue;
    double stiffest = 0;
    for (std::size_t i = 0; i < model.axial.size(); ++i)
      if (model.axial.a[i] >= organ.first && model.axial.a[i] < organ.first + organ.count)
        stiffest = std::max(stiffest, model.axial.slow_k(i));
    organ.modulus = kYoungOverEdge * stiffest / organ.spacing;
  }
}

void update_event(Event& event) {
  if (event.kind != EventKind::cut || event.text != piece_sentence || event.values.size() != 1) return;
  const double pieces = event.values[0];
  if (!(pieces >= 1 && pieces <= most_pieces)) return;
  event.kind = EventKind::piece_came_loose;
  event.pieces = static_cast<std::int32_t>(pieces);
}

}  // namespace ctpm::recordings::session_file

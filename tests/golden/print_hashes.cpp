// Prints the hashes of the golden sessions and of a larger block, for each instruction set of the machine and several
// thread counts. matrix.sh builds it in many configurations; all must print the same.

#include <cstdio>

#include "tests/golden/session.h"

using namespace ctpm;

namespace {

struct Session {
  const char* name;
  int ni, nj, nk, ticks;
  network::Structure structure;
  std::optional<Integrator> integrator;
  bool resists = false;  ///< inversion
  bool has_surface = false;
  std::int32_t hands = 1;
  Inputs (*inputs)(int) = testing::golden_inputs;
  bool is_light = false, is_full = false, is_strip = false;
};

constexpr Session kSessions[] = {
    {"mass-spring", 6, 5, 5, 400, network::Structure::mass_spring, std::nullopt},
    {"angle-mass-spring", 6, 5, 5, 400, network::Structure::angle_mass_spring, Integrator::backward_euler},
    {"tpm", 6, 5, 5, 400, network::Structure::tpm, std::nullopt},
    {"ctpm", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt},
    {"ctpm, second order", 6, 5, 5, 400, network::Structure::ctpm, Integrator::sdirk2},
    {"ctpm in slabs", 13, 12, 12, 40, network::Structure::ctpm, std::nullopt},
    {"mass-spring in slabs", 13, 12, 12, 40, network::Structure::mass_spring, std::nullopt},
    {"resisting", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, true},
    {"resisting in slabs", 13, 12, 12, 40, network::Structure::ctpm, Integrator::sdirk2, true},
    {"skinned", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true},
    {"skinned in slabs", 13, 12, 12, 40, network::Structure::ctpm, Integrator::sdirk2, false, true},
    {"touched cut", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true, 1, testing::touched_cut_inputs},
    {"touched tear", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true, 1,
     testing::touched_tear_inputs},
    {"touched bridge", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true, 1,
     testing::touched_bridge_inputs},
    {"touched plane", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true, 1,
     testing::touched_plane_inputs},
    {"touched edge", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true, 1,
     testing::touched_edge_inputs},
    {"two hands", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, true, 2, testing::two_hands_inputs},
    {"wedge", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, false, 1, testing::wedge_inputs, false,
     true},
    {"crumbs", 6, 5, 5, 400, network::Structure::ctpm, std::nullopt, false, false, 1, testing::crumbs_inputs, false,
     true},
    {"light", 6, 5, 5, 400, network::Structure::ctpm, Integrator::backward_euler, false, false, 1,
     testing::golden_inputs, true},
    {"long strip", 4, 14, 3, 400, network::Structure::ctpm, std::nullopt, false, true, 1, testing::strip_inputs, false,
     false, true},
};

}  // namespace

int main() {
  bool all_equal = true;
  for (const Session& session : kSessions) {
    const auto run = [&](const stepping::StepperOptions& options) {
      if (session.is_strip)
        return testing::run_golden(testing::make_strip_model(), session.ticks, session.integrator, options,
                                   session.inputs);
      if (session.has_surface)
        return testing::run_golden(
            testing::make_skinned_model(session.ni, session.nj, session.nk, false, session.hands), session.ticks,
            session.integrator, options, session.inputs);
      if (session.is_full)
        return testing::run_golden(testing::make_full_model(session.ni, session.nj, session.nk), session.ticks,
                                   session.integrator, options, session.inputs);
      if (session.is_light)
        return testing::run_golden(testing::make_light_model(session.ni, session.nj, session.nk), session.ticks,
                                   session.integrator, options);
      if (session.resists)
        return testing::run_golden(testing::make_resisting_model(session.ni, session.nj, session.nk, false),
                                   session.ticks, session.integrator, options);
      return testing::run_golden(session.ni, session.nj, session.nk, session.ticks, session.structure,
                                 session.integrator, options);
    };
    const testing::GoldenRun plain = run({1, elements::InstructionSet::baseline});
    for (const elements::InstructionSet set :
         {elements::InstructionSet::baseline, elements::InstructionSet::avx2, elements::InstructionSet::avx512})
      for (const int threads : {1, 2, 4}) {
        if (set > elements::best_instruction_set()) continue;
        const bool equal = run({threads, set}).hash == plain.hash;
        if (!equal) std::printf("%s differs with %s and %d threads\n", session.name, elements::name_of(set), threads);
        all_equal = all_equal && equal;
      }
    std::printf("%s:", session.name);
    for (const std::uint64_t hash : plain.hash) std::printf(" %016llx", (unsigned long long)hash);
    std::printf(plain.is_good ? "\n" : " and a tick failed\n");
    all_equal = all_equal && plain.is_good;
  }
  return all_equal ? 0 : 1;
}

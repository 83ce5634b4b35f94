#pragma once

#include <string>

#include "core/model/model.h"
#include "core/model/state.h"
#include "recordings/internal/bytes.h"

namespace ctpm::recordings::session_file {

/// Reads a Model from the field set at the reader, also one that an earlier program wrote (FORMAT.md section 4):
/// - `edges` and `tpms`, two tables of axial elements, become Model::axial;
/// - spheres without a lattice cell get one from their rest positions and the organ's spacing.
/// `problem` says what is wrong, empty if nothing is.
void get_model(ByteReader& in, Model& model, std::string& problem);

/// Reads a State likewise: `edge_severed`, `tpm_severed`, `edge_crossing` and `tpm_crossing` become
/// State::axial_severed and State::axial_crossing.
void get_state(ByteReader& in, State& state, std::string& problem);

}  // namespace ctpm::recordings::session_file

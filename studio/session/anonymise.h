#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/pseudonym.h"
#include "recordings/session_reader.h"

namespace ctpm::session {

/// Metadata of an anonymised session: the pseudonym of who moved the tool, and that its start is an elapsed time.
inline constexpr const char* trainee_key = "trainee";
inline constexpr const char* elapsed_key = "times";
inline constexpr const char* elapsed_word = "elapsed";

/// Whether created_unix_s() of a session counts from the first of the sessions with which it was anonymised.
bool begins_at_elapsed_time(const recordings::SessionReader& session);

struct AnonymiseRequest {
  std::vector<std::string> sessions;  ///< files
  std::string output;       ///< file of a single session; else, or where a folder is or a / ends it, the folder of all
  std::string trainee;      ///< name of who moved the tool in all of them; empty: the pseudonym that they have, if any
  bool keep_names = false;  ///< of organs, tools, cameras, probes, obstacles and the scene, as the author wrote them
};

struct AnonymisedSession {
  std::string from, to;
  std::string trainee;               ///< pseudonym; empty: nobody is named
  std::vector<std::string> removed;  ///< what was in the session and is no more, in words
};

/// What anonymising leaves in a session, and may still tell who moved the tool; one sentence each.
std::vector<std::string> what_stays();

/// Writes each session anew without names, texts, paths, devices, signatures and wall-clock times. Names become
/// pseudonyms of the key, but for the program's own words (presets, kinds of tools); sessions still name the session
/// that they continue, if both got the same key. A session begins as many seconds after 1970 as it began after the
/// first of all. Network, inputs, forces, States and hashes stay the same to the bit. Errors: those of all sessions
/// that cannot be read, are damaged or have no place at the output; then nothing is left behind.
Result<std::vector<AnonymisedSession>> anonymise(const AnonymiseRequest& request, const recordings::PseudonymKey& key);

}  // namespace ctpm::session

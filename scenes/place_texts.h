#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/json_text.h"
#include "scenes/places.h"
#include "scenes/problems.h"

// Texts that stand where a point or a direction belongs. Internal to scenes.
namespace ctpm::scenes {

/// Whether a place may stand for the value of this key of that record; and whether it is a direction.
bool takes_place(std::string_view record, std::string_view key);
bool takes_direction(std::string_view record, std::string_view key);

/// A text that was replaced by coordinates.
struct FoundPlace {
  std::size_t begin = 0, end = 0;  ///< bytes of the text without comments
  std::string phrase, coordinates;
};

/// What became of the texts.
struct PlaceTexts {
  std::vector<FoundPlace> found;
  std::vector<std::string> open;  ///< pointers of those that have coordinates which stand for nothing
};

/// Replaces each text that stands for a point or a direction in the tree of a scene or a script by coordinates, so that
/// it can be read. Where an organ or a probe is not known yet, they stand for nothing. Without a finder, a scene's own
/// names are known, and any name in a script. Adds what is wrong with a text to `problems`.
PlaceTexts find_places(JsonNode& root, bool is_script, PlaceFinder* finder, Problems& problems);

/// The text with coordinates in place of the texts that were found, each of which stays as a comment.
std::string with_coordinates(std::string_view text, const std::vector<FoundPlace>& found);

}  // namespace ctpm::scenes

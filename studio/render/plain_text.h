#pragma once

#include <string>

namespace ctpm::render {

/// A UTF-8 text in ASCII, for the letters of pictures are no others: letters lose their marks, and those of other
/// scripts are written as Latin ones ("Jörg" is "Jorg"). What has no such form is a question mark.
std::string plain_text(const std::string& text);

}  // namespace ctpm::render

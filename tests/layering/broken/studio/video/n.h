namespace ctpm::render {}  // namespace ctpm::render

namespace ctpm::video::inside {}
namespace ctpm::video_room {}

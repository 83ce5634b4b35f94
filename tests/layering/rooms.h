#pragma once

#include <string>
#include <vector>

namespace layering {

/// A room is a folder with all its subfolders; studio's `main.cpp` is a room of its own.
struct Room {
  std::string path;                 ///< from the root of the repository
  std::vector<std::string> before;  ///< rooms that it may include besides itself; each is declared before it
  std::string name_space;           ///< of every file in it
};

/// A package, known by how its headers' paths begin, and the only rooms that may include it.
struct Package {
  std::string prefix;
  std::vector<std::string> owners;
};

/// Every file declares its room's namespace.
constexpr bool kNamespacesAreRooms = true;

constexpr int kMostLines = 500;  ///< of a source file

/// All rooms of core in their order.
inline const std::vector<std::string> kCore{"core/model",     "core/parallel", "core/network", "core/surface",
                                            "core/elements",  "core/cutting",  "core/cutbody", "core/contact",
                                            "core/inversion", "core/solver",   "core/stepping"};

inline std::vector<std::string> core_and(std::vector<std::string> more) {
  more.insert(more.begin(), kCore.begin(), kCore.end());
  return more;
}

/// The declared order.
inline const std::vector<Room> kRooms{
    {"core/model", {}, "ctpm"},
    {"core/parallel", {"core/model"}, "ctpm::parallel"},
    {"core/network", {"core/model"}, "ctpm::network"},
    {"core/surface", {"core/model"}, "ctpm::surface"},
    {"core/elements", {"core/model", "core/parallel"}, "ctpm::elements"},
    {"core/cutting", {"core/model", "core/parallel", "core/elements"}, "ctpm::cutting"},
    {"core/cutbody", {"core/model", "core/surface", "core/cutting"}, "ctpm::cutbody"},
    {"core/contact",
     {"core/model", "core/parallel", "core/surface", "core/elements", "core/cutting", "core/cutbody"},
     "ctpm::contact"},
    {"core/inversion", {"core/model", "core/parallel", "core/elements", "core/contact"}, "ctpm::inversion"},
    {"core/solver", {"core/model", "core/parallel", "core/elements"}, "ctpm::solver"},
    {"core/stepping",
     {"core/model", "core/parallel", "core/elements", "core/cutting", "core/contact", "core/inversion", "core/solver"},
     "ctpm::stepping"},
    {"importers", core_and({}), "ctpm::importers"},
    {"scenes", core_and({}), "ctpm::scenes"},
    {"recordings", core_and({}), "ctpm::recordings"},
    {"studio/output", core_and({}), "ctpm::output"},
    {"studio/version", {}, "ctpm::version"},
    {"studio/render", core_and({"studio/output"}), "ctpm::render"},
    {"studio/video", core_and({"studio/render"}), "ctpm::video"},
    {"studio/views", core_and({"scenes", "studio/output", "studio/render"}), "ctpm::views"},
    {"studio/reports", core_and({"recordings", "studio/output", "studio/render"}), "ctpm::reports"},
    {"studio/rig", core_and({"scenes"}), "ctpm::rig"},
    {"studio/loading", core_and({"scenes", "importers"}), "ctpm::loading"},
    {"studio/sources", core_and({"scenes", "recordings", "studio/output"}), "ctpm::sources"},
    {"studio/devices", core_and({"recordings", "studio/output", "studio/sources"}), "ctpm::devices"},
    {"studio/session",
     core_and(
         {"scenes", "importers", "recordings", "studio/output", "studio/version", "studio/loading", "studio/sources"}),
     "ctpm::session"},
    {"studio/sweep",
     core_and({"scenes", "recordings", "studio/output", "studio/reports", "studio/loading", "studio/sources",
               "studio/session"}),
     "ctpm::sweep"},
    {"studio/film",
     core_and({"scenes", "recordings", "studio/output", "studio/version", "studio/render", "studio/video",
               "studio/views", "studio/loading", "studio/session"}),
     "ctpm::film"},
    {"studio/exchange", core_and({"scenes", "recordings", "studio/output", "studio/loading", "studio/session"}),
     "ctpm::exchange"},
    {"studio/compare",
     core_and({"scenes", "recordings", "studio/output", "studio/reports", "studio/loading", "studio/session"}),
     "ctpm::compare"},
    {"studio/cohort",
     core_and({"scenes", "recordings", "studio/output", "studio/reports", "studio/loading", "studio/session",
               "studio/compare"}),
     "ctpm::cohort"},
    {"studio/authoring",
     core_and({"scenes", "importers", "studio/output", "studio/render", "studio/rig", "studio/loading"}),
     "ctpm::authoring"},
    {"studio/calibrate", core_and({"scenes", "studio/output", "studio/reports", "studio/rig", "studio/loading"}),
     "ctpm::calibrate"},
    {"studio/paper",
     core_and({"scenes", "studio/output", "studio/render", "studio/views", "studio/reports", "studio/rig",
               "studio/loading"}),
     "ctpm::paper"},
    {"studio/fidelity", core_and({"scenes", "importers", "studio/output", "studio/reports", "studio/loading"}),
     "ctpm::fidelity"},
    {"studio/stability", core_and({"scenes", "recordings", "studio/output", "studio/reports", "studio/fidelity"}),
     "ctpm::stability"},
    {"studio/bench",
     core_and({"scenes", "studio/output", "studio/reports", "studio/rig", "studio/loading", "studio/fidelity"}),
     "ctpm::bench"},
    {"studio/server",
     core_and({"scenes", "importers", "recordings", "studio/output", "studio/version", "studio/render", "studio/views",
               "studio/reports", "studio/loading", "studio/sources", "studio/devices", "studio/session", "studio/film",
               "studio/compare", "studio/authoring", "studio/fidelity"}),
     "ctpm::server"},
    {"studio/commands",
     core_and({"scenes",          "importers",        "recordings",     "studio/output",   "studio/version",
               "studio/render",   "studio/views",     "studio/reports", "studio/loading",  "studio/sources",
               "studio/devices",  "studio/session",   "studio/film",    "studio/compare",  "studio/authoring",
               "studio/paper",    "studio/stability", "studio/bench",   "studio/fidelity", "studio/server",
               "studio/exchange", "studio/cohort",    "studio/sweep",   "studio/calibrate"}),
     "ctpm::commands"},
    {"studio/main.cpp", {"core/model", "studio/commands"}, "ctpm"},
};

inline const std::vector<Package> kPackages{
    {"Eigen/", {"core/surface", "studio/rig", "studio/calibrate"}},
    {"assimp/", {"importers", "studio/exchange"}},
    {"CGAL/", {"importers"}},
    {"itk", {"importers"}},
    {"zlib", {"importers"}},
    {"boost/", {"importers", "studio/calibrate", "studio/server"}},
    {"ceres/", {"studio/calibrate"}},
    {"glog/", {"studio/calibrate"}},
    {"nlohmann/", {"scenes", "studio/sweep", "studio/server"}},
    {"sqlite3", {"recordings"}},
    {"zstd", {"recordings"}},
    {"openssl/", {"recordings"}},
    {"xxhash", {"recordings"}},
    {"CLI/", {"studio/commands", "studio/main.cpp"}},
    {"GL/", {"studio/render"}},
    {"opencv2/", {"studio/render", "studio/video", "studio/reports", "studio/compare"}},
    {"openigtlink/", {"studio/devices"}},
    {"gtest/", {}},
    {"benchmark/", {}},
};

}  // namespace layering

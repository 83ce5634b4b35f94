#pragma once

#include <span>
#include <string>
#include <vector>

#include "studio/fidelity/body.h"
#include "studio/fidelity/fidelity.h"
#include "studio/fidelity/press.h"

// The recipes: each measures one thing and returns plain numbers; chapter_of() puts them into words and tables.
namespace ctpm::fidelity {

/// A bar of 48 x 48 x 96 mm, both ends held along z only, 1 % longer.
struct TensionResult {
  struct Row {
    double radius = 0;  ///< [m]
    std::size_t spheres = 0;
    double force = 0;          ///< through the bar [N]
    double modulus_ratio = 0;  ///< E / E0 [1]
    double poisson = 0;        ///< of the drawn sides at half length [1]
  };
  std::vector<Row> rows;  ///< coarsest first
};
Result<TensionResult> measure_tension(std::span<const double> radii);
Chapter chapter_of(const TensionResult& result);

/// A beam of 24 x 24 x 120 mm under a hundredth of its weight, clamped over its first 12 mm.
struct CantileverResult {
  /// How the beam lies in the lattice.
  struct Pose {
    std::string name;
    Quat turn;
    Vec3 shift;  ///< [spacings]
  };
  struct Row {
    double radius = 0;  ///< [m]
    std::string pose;
    std::size_t spheres = 0;
    double sag = 0;  ///< of the end's middle [m]
    bool rests = true;
  };
  std::vector<Row> rows;  ///< coarsest first
};
Result<CantileverResult> measure_cantilever(std::span<const double> radii);
Chapter chapter_of(const CantileverResult& result);

/// A block of 96 x 96 x 60 mm, bottom held, frictionless ball of 20 mm at places over one lattice cell.
struct IndentationResult {
  struct Row {
    double radius = 0;           ///< [m]
    double depth = 0;            ///< [m]
    std::vector<double> forces;  ///< one a place [N]
    bool rests = true;
  };
  int places = 0;  ///< along each side of the cell
  std::vector<Row> rows;
};
Result<IndentationResult> measure_indentation(std::span<const double> radii, int places);
Chapter chapter_of(const IndentationResult& result);

/// A ball organ of 40 mm radius, its lower cap (12 mm) held, pressed at its pole by a ball of 10 mm, turned against the
/// lattice.
struct OrientationResult {
  struct Row {
    double radius = 0;           ///< [m]
    double depth = 0;            ///< [m]
    std::vector<double> forces;  ///< one a turn [N]
    bool rests = true;
  };
  std::vector<Row> rows;
};
Result<OrientationResult> measure_orientation(std::span<const double> radii, std::span<const Quat> turns);
Chapter chapter_of(const OrientationResult& result);

/// Presses of one body as rows, one a depth.
std::vector<OrientationResult::Row> rows_of(const std::vector<std::vector<PressPoint>>& presses, double radius,
                                            std::span<const double> depths);

/// Adds the scatter of forces over `over` ("turns", "places"): a table to the section, and figures for each row.
void add_scatter(Chapter& chapter, const std::vector<OrientationResult::Row>& rows, const std::string& over);

/// The first contact of balls of 4 and 10 mm that come down on a flat block at places over one lattice cell.
struct FirstContactResult {
  struct Row {
    double radius = 0, ball = 0;  ///< [m]
    std::vector<double> depths;  ///< of the ball below the drawn surface at the first force, one a place [m]; NaN: none
  };
  std::vector<Row> rows;
};
Result<FirstContactResult> measure_first_contact(std::span<const double> radii, int places);

/// Depth of a ball below the drawn surface at the first force [m], as it comes down; NaN if there is none before 15 mm.
double first_contact(const Body& body, std::int32_t tool, const PressSite& site);

/// Adds the rows as a table, and a figure for each.
void add_contacts(Chapter& chapter, const std::vector<FirstContactResult::Row>& rows);
Chapter chapter_of(const FirstContactResult& result);

/// What a press shows: the drawn surface inside a ball of 10 mm, and the force on a ball of 2 mm, at places over a
/// cell.
struct SurfaceResult {
  struct Inside {
    double radius = 0, depth = 0;  ///< [m]
    std::vector<double> inside;    ///< depth of the drawn surface in the ball, one a place [m]
  };
  struct Small {
    double radius = 0;           ///< [m]
    std::vector<double> forces;  ///< on the ball of 2 mm at 8 mm, one a place [N]
  };
  std::vector<Inside> inside;
  std::vector<Small> small;
};
Result<SurfaceResult> measure_surface(std::span<const double> radii, int places);
Chapter chapter_of(const SurfaceResult& result);

/// A ball that is drawn over a flat block at constant depth.
struct DragResult {
  struct Row {
    double radius = 0, ball = 0, depth = 0;  ///< [m]
    double angle = 0;                        ///< of the way against the lattice [rad]
    std::vector<double> way;                 ///< from the block's middle [m]      (tick_count)
    std::vector<double> normal, tangential;  ///< forces on the ball [N]           (tick_count)
    std::int64_t lost_ticks = 0;             ///< ticks without contact
    Spread ripple;                           ///< of the normal force without its trend
    double peak_to_peak = 0;                 ///< of the normal force over its mean [share]
    double most_friction = 0;                ///< largest tangential over normal force
  };
  double friction = 0;  ///< Coulomb coefficient
  std::vector<Row> rows;
};
Result<DragResult> measure_drag(std::span<const double> radii, bool is_quick);
Chapter chapter_of(const DragResult& result);

/// A blade that cuts a straight line through a block of 72 x 72 x 36 mm, 20 mm deep.
struct BladeResult {
  struct Row {
    double radius = 0, toughness = 0;  ///< [m], [J/m^2]
    double angle = 0;                  ///< of the way against the lattice [rad]
    std::vector<double> way, force;    ///< [m] from the block's middle, [N] against the way      (tick_count)
    double work = 0;                   ///< of the hand [J]
    double area = 0;                   ///< of the cut [m^2]
    double viscous = 0;                ///< energy that Kelvin units dissipated [J]
    double severed = 0;                ///< energy that elements held when they were severed [J]
    double mean = 0;                   ///< force in the middle 30 mm [N]
    double chatter = 0;                ///< of that force about its moving mean over 6 mm, RMS over mean [share]
    double jump = 0;                   ///< its largest change in one tick over the mean [share]
    double opening = 0;                ///< beside the flanks over the blade's thickness, mean of the middle 30 mm [1]
  };
  std::vector<Row> rows;
};
Result<BladeResult> measure_blade(std::span<const double> radii, std::span<const double> toughnesses);
Chapter chapter_of(const BladeResult& result);

/// The Model of a shipped scene whose organ is filled with spheres `finer` times as small.
Result<Model> load_organ(const std::string& path, double finer);

/// Cuts of eleven kinds through the shipped kidney, skin and liver at rest.
struct CutsResult {
  struct Row {
    std::string organ, cut;
    double radius = 0;                   ///< [m]
    int pieces = 0;                      ///< of tissue
    int components = 0, open_edges = 0;  ///< of the drawn surface
    double off = 0;                      ///< largest distance of a wall from the swept surface [spacings]
    std::size_t triangles = 0;
  };
  std::vector<Row> rows;
};
/// `shipped`: folder of the shipped scenes. `is_quick`: only at their own filling, else also at half its radius.
Result<CutsResult> measure_cuts(const std::string& shipped, bool is_quick);
Chapter chapter_of(const CutsResult& result);

/// Blades that cut the shipped kidney, skin and liver in motion.
struct StrokesResult {
  struct Row {
    std::string organ, stroke;
    double radius = 0;             ///< [m]
    int severed = 0, refused = 0;  ///< elements; ticks
    int looks = 0;
    int wrong = 0;  ///< looks at which the drawn surface was open, or had other components than there were pieces
    int changed_uncut = 0;       ///< looks at which it was another one, but nothing had been swept since the last look
    double stretch = 0;          ///< of a triangle's longest edge, over that at rest: the largest of all looks
    double carried_stretch = 0;  ///< the same where the spheres carry it, before what is drawn spreads the stretch
    /// Triangles of all looks that were stretched more than six times: without elements under them that are stretched
    /// half as much, and with such.
    int stretched = 0, pulled = 0;
    double torn = 0;  ///< how far places that lie together at rest came apart [spacings]
  };
  std::vector<Row> rows;
};
/// `shipped`: folder of the shipped scenes. `is_quick`: only the straight stroke, through the kidney; else all, also
/// at half its radius.
Result<StrokesResult> measure_strokes(const std::string& shipped, bool is_quick);
Chapter chapter_of(const StrokesResult& result);

/// Blocks of liver of which a blade cuts pieces, which fall on the ground.
struct PiecesResult {
  struct Row {
    std::string cut;
    double radius = 0;   ///< [m]
    int pieces = 0;      ///< that should be there
    int of_tissue = 0;   ///< of spheres, when all is at rest
    int came_loose = 0;  ///< as ticks told
    int wrong = 0;       ///< looks at which the drawn surface had other components than there were pieces, or was open
    int looks = 0;
    double speed = 0, inside = 0;  ///< at rest: of the fastest sphere [m/s]; of the surface below the ground [m]
    bool on_ground = false;        ///< every piece but the anchored one lies on it
  };
  std::vector<Row> rows;
};
Result<PiecesResult> measure_pieces(double radius);
Chapter chapter_of(const PiecesResult& result);

/// A ball of 10 mm, 4 mm deep, that moves sideways by 0.3 mm, far below the cone, waits for 10 s, and then slips.
struct GripResult {
  struct Sample {
    double time;      ///< since the ball stopped [s]
    double friction;  ///< tangential over normal force [1]
  };
  std::vector<Sample> held;               ///< while it waits
  std::vector<Sample> slips;              ///< while it moves on by 24 mm; times since it began
  double radius = 0;                      ///< [m]
  double coefficient = 0;                 ///< Coulomb coefficient of the scene
  double friction_at(double time) const;  ///< of `held`, at the sample nearest to `time`
};
Result<GripResult> measure_grip(double radius);
Chapter chapter_of(const GripResult& result);

/// A block of 72 x 72 x 48 mm after four kinds of abuse, 4 s after they ended.
struct RecoveryResult {
  struct Row {
    double radius = 0;  ///< [m]
    std::string name;
    double reach = 0;     ///< largest distance of a sphere from rest during the abuse [m]
    double residual = 0;  ///< largest distance 4 s later [m]
    std::int64_t cells = 0, worst_inside_out = 0, inside_out = 0;  ///< all; most during the abuse; 4 s later
    std::int64_t refused_ticks = 0;
    reports::Series distance;  ///< over time [s]: largest distance from rest [mm]
  };
  std::vector<Row> rows;
};
Result<RecoveryResult> measure_recovery(std::span<const double> radii);
Chapter chapter_of(const RecoveryResult& result);

/// A ball of 20 mm that enters a block by 4 mm in a ramp and stays.
struct RelaxationResult {
  struct Row {
    double radius = 0;           ///< [m]
    double ramp = 0;             ///< [s]
    double final_force = 0;      ///< mean over the places [N]
    std::vector<double> ratios;  ///< force at the ramp's end over the final force, one a place
    reports::Series force;       ///< at the first place, over time [s]: over the final force
  };
  std::vector<Row> rows;
};
Result<RelaxationResult> measure_relaxation(std::span<const double> radii, std::span<const double> ramps);
Chapter chapter_of(const RelaxationResult& result);

/// Free bodies: a ball organ of 40 mm radius that spins at 10 rad/s for 1 s, and one that falls for 0.3 s.
struct FreeMotionResult {
  double radius = 0;            ///< [m]
  std::string integrator;       ///< that `auto` took
  double angular_momentum = 0;  ///< after the spin, over that before [1]
  double energy = 0;            ///< kinetic energy after the spin, over that before [1]
  double fall = 0;              ///< of the centre of mass, over g t^2 / 2 [1]
  double shape = 0;             ///< largest deviation from a rigid fall [m]
};
Result<FreeMotionResult> measure_free_motion(double radius);
Chapter chapter_of(const FreeMotionResult& result);

/// Organs that fall on the ground and on each other, collide, and lie on slopes.
struct MeetingResult {
  struct Rest {
    std::string on;
    double overlap = 0;  ///< largest depth of the drawn surface inside what it lies on; negative: a gap [m]
    double speed = 0;    ///< of the fastest sphere [m/s]
  };
  double radius = 0;       ///< [m]
  std::string integrator;  ///< that `auto` took for the collision
  std::vector<Rest> rests;
  double momentum = 0;          ///< change in the collision, over that of one organ before [1]
  double angular_momentum = 0;  ///< the same, over that of one organ at the other's surface [1]
  double rebound = 0;           ///< speed after over before the collision, of one organ's centre [1]
  double creep = 0;             ///< way down a slope that friction holds [m]
  double slide = 0;             ///< way down a steep slope, over Coulomb's [1]
};
Result<MeetingResult> measure_meeting(double radius);
Chapter chapter_of(const MeetingResult& result);

/// Order of convergence of errors at radii, from a least-squares line through the logarithms; NaN with fewer than two.
double order_of(const std::vector<double>& radii, const std::vector<double>& errors);

/// A block of liver that stands on z = 0, centred over the origin, its bottom held. `size` [m].
Specimen block(Vec3 size, double radius, Pace pace, const std::vector<double>& balls);

/// A ball organ of 40 mm radius about the origin, nothing held.
Specimen ball_organ(double radius, Pace pace);

}  // namespace ctpm::fidelity

#include "studio/compare/measure_table.h"

namespace ctpm::compare {
namespace {

constexpr const char* kCotin =
    "Cotin et al., Metrics for laparoscopic skills trainers: the weakest link! MICCAI 2002, 35-43";
constexpr const char* kGallagher =
    "Gallagher and Satava, Virtual reality as a metric for the assessment of laparoscopic psychomotor "
    "skills, "
    "Surg Endosc 16, 2002, 1746-1752";
constexpr const char* kBalasubramanian =
    "Balasubramanian et al., On the analysis of movement smoothness, J NeuroEng Rehabil 12:112, 2015";
constexpr const char* kDAngelo =
    "D'Angelo et al., Idle time: an underdeveloped performance metric for assessing surgical skill, Am J "
    "Surg "
    "209, 2015, 645-651; the limits are this program's";
constexpr const char* kHoreman =
    "Horeman et al., Force parameters for skills assessment in laparoscopy, IEEE Trans Haptics 5, 2012, "
    "312-322";
constexpr const char* kTrejos =
    "Trejos et al., Development of force-based metrics for skills assessment in minimally invasive surgery, "
    "Surg Endosc 28, 2014, 2106-2119";
constexpr const char* kDice =
    "Dice, Measures of the amount of ecologic association between species, Ecology 26, 1945, 297-302";
constexpr const char* kHeimann =
    "Heimann et al., Comparison and evaluation of methods for liver segmentation from CT datasets, IEEE "
    "Trans "
    "Med Imaging 28, 2009, 1251-1265: average symmetric distance";
constexpr const char* kHuttenlocher =
    "Huttenlocher et al., Comparing images using the Hausdorff distance, IEEE Trans Pattern Anal 15, 1993, "
    "850-863";
constexpr const char* kSakoe =
    "Sakoe and Chiba, Dynamic programming algorithm optimization for spoken word recognition, IEEE Trans "
    "Acoust Speech 26, 1978, 43-49";
constexpr const char* kScene = "the scene's damage_depth_mm";
constexpr const char* kOwn = "this program's";
constexpr const char* kNetwork = "the scene's network";

using enum Direction;
constexpr bool kGrows = true;
// Differences that rounding, or the 100 Hz of hands, can make.
constexpr double kTimeRounding = 0.02, kLengthRounding = 0.1, kForceRounding = 0.01;  // [s], [mm], [N]

}  // namespace

const Measure kCompletionTime{"completion_time_s",
                              "completion time",
                              "s",
                              lower,
                              "from taking the first tool to putting the last one away",
                              kCotin,
                              kTimeRounding,
                              kGrows};
const Measure kPathLength{"path_length_mm", "path length",       "mm",  lower, "way of the tool's tip while it is held",
                          kCotin,           5 * kLengthRounding, kGrows};
const Measure kEconomy{"economy_of_motion",
                       "economy of motion",
                       "1",
                       higher,
                       "straight lines from taking the tool over touching, deepest point or ends of the "
                       "cut, and leaving, to putting it away, divided by the way between",
                       kGallagher,
                       0.01};
const Measure kSparc{"spectral_arc_length",
                     "smoothness, spectral arc length",
                     "1",
                     higher,
                     "of the tip's speed in each movement between two rests; nearer to 0 is smoother",
                     kBalasubramanian,
                     0.02};
const Measure kJerk{"log_dimensionless_jerk",
                    "smoothness, log dimensionless jerk",
                    "1",
                    higher,
                    "of the tip's speed in each movement between two rests; larger is smoother",
                    kBalasubramanian,
                    0.1};
const Measure kIdle{
    "idle_time_s", "idle time",      "s", lower, "a tool in the hand, slower than 5 mm/s for at least 0.3 s",
    kDAngelo,      2 * kTimeRounding};
const Measure kPeakForce{"peak_force_n", "peak force",   "N",   lower, "largest force between tool and tissue",
                         kHoreman,       kForceRounding, kGrows};
const Measure kMeanForce{"mean_force_n",
                         "mean force",
                         "N",
                         lower,
                         "over the way of the tool against a force, so that resting in the tissue does not count",
                         kHoreman,
                         kForceRounding,
                         kGrows};
const Measure kOtherPeakForce{"other_hand_peak_force_n",
                              "peak force of the other hand",
                              "N",
                              lower,
                              "the same of the hand that does not cut",
                              kHoreman,
                              kForceRounding};
const Measure kTimeAbove{"time_above_force_limit_s",
                         "time above the force limit",
                         "s",
                         lower,
                         "with a force above the limit",
                         kTrejos,
                         kTimeRounding,
                         kGrows};
const Measure kImpulseAbove{"impulse_above_force_limit_n_s",
                            "impulse above the force limit",
                            "N s",
                            lower,
                            "integral over time of what is above the limit",
                            kTrejos,
                            kTimeRounding* kForceRounding,
                            kGrows};
const Measure kImpulse{
    "impulse_n_s", "impulse", "N s", lower, "integral of the force over time", kTrejos, kTimeRounding* kForceRounding,
    kGrows};
const Measure kWork{"work_on_tissue_mj",
                    "work on the tissue",
                    "mJ",
                    lower,
                    "of the tool against the force of the tissue, where it moves against it",
                    kOwn,
                    kForceRounding* kLengthRounding,
                    kGrows};
const Measure kWorkAbove{"work_above_force_limit_mj",
                         "work above the force limit",
                         "mJ",
                         lower,
                         "the same of the part of the force that is above the limit",
                         kOwn,
                         kForceRounding* kLengthRounding,
                         kGrows};
const Measure kZoneTime{"time_in_forbidden_zones_s",
                        "time in forbidden zones",
                        "s",
                        lower,
                        "with any part of a ball, or of a blade's edge, in a zone that the scene forbids",
                        kOwn,
                        kTimeRounding};
const Measure kZoneImpulse{"impulse_in_forbidden_zones_n_s",
                           "impulse in forbidden zones",
                           "N s",
                           lower,
                           "integral of the force over the time in them",
                           kOwn,
                           kTimeRounding* kForceRounding};
const Measure kZoneWork{
    "work_in_forbidden_zones_mj",   "work in forbidden zones", "mJ", lower, "of the tool on the tissue in them", kOwn,
    kForceRounding* kLengthRounding};
const Measure kDepth{
    "largest_depth_mm", "largest depth", "mm", nearer, "how far a tool without a blade pushes the tissue from rest",
    kNetwork,           kLengthRounding};
const Measure kBeyondDamage{"time_beyond_damage_depth_s",
                            "time beyond the damage depth",
                            "s",
                            lower,
                            "with tissue pushed deeper than it can bear",
                            kScene,
                            kTimeRounding};
const Measure kSevered{
    "elements_severed", "elements severed", "1", nearer, "springs and constraints of the network", kNetwork};
const Measure kSeveredBoth{
    "elements_severed_by_both", "elements severed by both", "1", higher, "the same elements", kNetwork};
const Measure kSeveredExpert{"elements_severed_by_expert_only",
                             "elements only the expert severed",
                             "1",
                             lower,
                             "left whole by the trainee",
                             kNetwork};
const Measure kSeveredTrainee{"elements_severed_by_trainee_only",
                              "elements only the trainee severed",
                              "1",
                              lower,
                              "left whole by the expert",
                              kNetwork};
const Measure kOverlap{"cut_overlap",
                       "overlap of the cuts",
                       "1",
                       higher,
                       "Dice coefficient of the severed elements: 1 the same, 0 none in common",
                       kDice};
const Measure kCutMean{"cut_path_mean_distance_mm",
                       "mean distance of the cut paths",
                       "mm",
                       lower,
                       "of points on either path from the other, where elements were severed",
                       kHeimann};
const Measure kCutHausdorff{"cut_path_hausdorff_mm",
                            "Hausdorff distance of the cut paths",
                            "mm",
                            lower,
                            "the farthest that a point of either path is from the other",
                            kHuttenlocher};
const Measure kCutDepth{"cut_depth_mm",
                        "depth of the cut",
                        "mm",
                        nearer,
                        "from the nearest surface to the deepest place that the blade's edge cut, at rest",
                        kNetwork,
                        kLengthRounding};
const Measure kCutAlongBlade{"cut_depth_along_blade_mm",
                             "depth of the cut along the blade",
                             "mm",
                             nearer,
                             "from the deepest place that the blade's edge cut along the blade to the surface, at rest",
                             kNetwork,
                             kLengthRounding};
const Measure kCutLength{"cut_length_mm", "length of the cut", "mm", nearer, "along the surface at rest, of all cuts",
                         kNetwork,        kLengthRounding};
const Measure kCutArea{
    "cut_area_mm2", "area of the cut", "mm^2", nearer, "that the blade's edge swept in the tissue at rest", kNetwork};
const Measure kAlignedMean{"aligned_deviation_mean_mm",
                           "mean deviation of the aligned paths",
                           "mm",
                           lower,
                           "of the tip from the expert's, whatever the pace",
                           kSakoe};
const Measure kAlignedLargest{"aligned_deviation_largest_mm",
                              "largest deviation of the aligned paths",
                              "mm",
                              lower,
                              "of the tip from the expert's, whatever the pace",
                              kSakoe};

std::span<const Measure* const> all_measures() {
  static constexpr const Measure* measures[] = {
      &kCompletionTime, &kPathLength,     &kEconomy,     &kSparc,         &kJerk,         &kIdle,     &kPeakForce,
      &kMeanForce,      &kOtherPeakForce, &kTimeAbove,   &kImpulseAbove,  &kImpulse,      &kWork,     &kWorkAbove,
      &kZoneTime,       &kZoneImpulse,    &kZoneWork,    &kDepth,         &kBeyondDamage, &kSevered,  &kSeveredBoth,
      &kSeveredExpert,  &kSeveredTrainee, &kOverlap,     &kCutMean,       &kCutHausdorff, &kCutDepth, &kCutAlongBlade,
      &kCutLength,      &kCutArea,        &kAlignedMean, &kAlignedLargest};
  return measures;
}

std::vector<std::string> measure_keys() {
  std::vector<std::string> keys;
  for (const Measure* measure : all_measures()) keys.emplace_back(measure->key);
  return keys;
}

}  // namespace ctpm::compare

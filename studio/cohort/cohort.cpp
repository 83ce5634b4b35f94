#include "studio/cohort/cohort.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "core/model/errors.h"
#include "core/parallel/team.h"
#include "recordings/byte_hash.h"
#include "recordings/session_reader.h"
#include "scenes/scene_file.h"
#include "studio/compare/measure_table.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/number_text.h"

namespace ctpm::cohort {
namespace {

using compare::SessionTrack;
using compare::SessionValue;
using recordings::SessionReader;

/// A session that was read, before it is compared with experts.
struct ReadSession {
  Attempt attempt;
  SessionTrack track;
  compare::TimedPath way;
};

/// A task's experts, beside which sessions are measured.
struct Experts {
  std::vector<ReadSession> sessions;
  std::size_t middle = 0;  ///< whose way is nearest to those of all others
  std::vector<SessionValue> pair_of(const ReadSession& session,
                                    const std::vector<compare::Alignment>& alignments) const;
};

std::uint64_t motion_hash(const SessionTrack& track) {
  recordings::ByteHash hash;
  const auto add = [&](const auto& values) { hash.add(values.data(), values.size() * sizeof values[0]); };
  add(track.tip), add(track.force), add(track.depth);
  return hash.value();
}

Result<ReadSession> read_session(const FoundSession& found, const TaskResult& task, const CohortOptions& options) {
  Result<SessionReader> reader = SessionReader::open(found.file);
  if (!reader) return reader.errors();
  Result<SessionTrack> track =
      compare::read_track(*reader, options.verify ? compare::Replaying::all : compare::Replaying::ends);
  if (!track) return track.errors();
  ReadSession read;
  Attempt& attempt = read.attempt;
  attempt.session = found, attempt.duration_s = track->seconds(track->tick_count());
  attempt.physics_revision = reader->start().physics_revision;
  attempt.values = compare::measure_session(*track, task.force_limit, compare::damage_depth_of(reader->start().model));
  compare::refuse_times(attempt.values, *track);
  attempt.structures = compare::loads_of(*track, reader->start().model).value_or(std::vector<compare::StructureLoad>());
  if (!track->has_end) attempt.remarks.push_back("has no clean end: what is there is measured");
  if (!track->replays) attempt.remarks.push_back("does not replay as it was recorded");
  if (options.verify && !track->is_verified && track->replays) attempt.remarks.push_back("could not be verified");
  if (!track->is_timed) attempt.remarks.push_back("lacks " + output::fixed(track->slip, 3) + " s of real time");
  attempt.motion_hash = motion_hash(*track);
  read.way = compare::tool_path(*track);
  read.track = std::move(*track);
  return read;
}

/// Means of the measures of pairs over several experts; a measure that one pair lacks has no value.
std::vector<SessionValue> means_of(const std::vector<std::vector<SessionValue>>& pairs) {
  std::vector<SessionValue> means = pairs.front();
  for (std::size_t i = 0; i < means.size(); ++i) {
    double sum = 0;
    for (const std::vector<SessionValue>& pair : pairs) {
      if (pair[i].value)
        sum += *pair[i].value;
      else if (means[i].note.empty())
        means[i].note = pair[i].note.empty() ? "insufficient data" : pair[i].note;
    }
    const bool is_whole = std::ranges::all_of(pairs, [&](const auto& pair) { return pair[i].value.has_value(); });
    means[i].value = is_whole ? std::optional(sum / double(pairs.size())) : std::nullopt;
  }
  return means;
}

/// `alignments`: from each expert to the session. An expert is not compared with itself.
std::vector<SessionValue> Experts::pair_of(const ReadSession& session,
                                           const std::vector<compare::Alignment>& alignments) const {
  std::vector<std::vector<SessionValue>> pairs;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    if (&sessions[i] == &session) continue;
    std::vector<SessionValue> values = compare::measure_cut_pair(sessions[i].track, session.track);
    if (sessions[i].track.cuts.empty() && session.track.cuts.empty())
      for (SessionValue& value : values) value.value.reset(), value.note = "nobody cut";
    const std::vector<SessionValue> aligned = compare::measure_aligned(alignments[i]);
    values.insert(values.end(), aligned.begin(), aligned.end());
    pairs.push_back(std::move(values));
  }
  return means_of(pairs);
}

/// Puts the values into the order of the table of measures.
std::vector<SessionValue> in_order(const std::vector<SessionValue>& own, const std::vector<SessionValue>& pair) {
  std::vector<SessionValue> all;
  for (const compare::Measure* measure : compare::all_measures()) {
    SessionValue value{measure, {}, "insufficient data"};
    for (const auto* values : {&own, &pair})
      for (const SessionValue& one : *values)
        if (one.measure == measure) value = one;
    if (!value.value && value.note.empty()) value.note = "insufficient data";
    all.push_back(value);
  }
  return all;
}

std::vector<compare::Alignment> alignments_from(const std::vector<ReadSession>& experts, const ReadSession& session) {
  std::vector<compare::Alignment> alignments;
  for (const ReadSession& expert : experts)
    alignments.push_back(compare::align_paths(expert.way.place, session.way.place));
  return alignments;
}

/// Measures a session beside the experts, and forgets its ticks.
Attempt beside(const Experts& experts, const ReadSession& session, const std::vector<compare::Alignment>& alignments,
               const scenes::TaskSpec& task) {
  Attempt attempt = session.attempt;
  attempt.values = in_order(attempt.values, experts.pair_of(session, alignments));
  attempt.curve =
      stroke_curve(experts.sessions[experts.middle].way, alignments[experts.middle], session.way, session.track);
  attempt.passed = judge(attempt.values, task, attempt.missed);
  return attempt;
}

void set_force_limit(TaskResult& task, const std::string& session) {
  if (task.task.force_limit) {
    task.force_limit = task.task.force_limit, task.force_limit_from = "the course";
    return;
  }
  const Result<SessionReader> reader = SessionReader::open(session);
  if (!reader) return;
  const Result<scenes::SceneText> scene = scenes::read_scene(reader->start().scene_text, session);
  const double limit = scene ? loading::damage_force_of(scene->spec) : 0;
  if (limit > 0) task.force_limit = limit, task.force_limit_from = "the scene";
}

/// Reads and measures the experts of a task, and the band that they make.
Result<Experts> measure_experts(TaskResult& task, const std::vector<FoundSession>& found, const CohortOptions& options,
                                const std::function<void()>& tell) {
  set_force_limit(task, found.front().file);
  parallel::Team team(options.threads);
  std::vector<std::optional<Result<ReadSession>>> read(found.size());
  team.for_each(int(found.size()), [&](int at) {
    const auto i = std::size_t(at);
    read[i] = read_session(found[i], task, options);
    tell();
  });
  Experts experts;
  Errors errors;
  for (auto& one : read) {
    if (*one)
      experts.sessions.push_back(std::move(**one));
    else
      append(errors, *one);
  }
  if (!errors.empty()) return errors;
  const std::size_t count = experts.sessions.size();
  std::vector<std::vector<compare::Alignment>> alignments(count);
  team.for_each(int(count), [&](int at) {
    const auto i = std::size_t(at);
    alignments[i] = alignments_from(experts.sessions, experts.sessions[i]);
  });
  double nearest = INFINITY;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (const compare::Alignment& alignment : alignments[i]) sum += alignment.mean;
    if (sum < nearest) nearest = sum, experts.middle = i;
  }
  std::vector<StrokeCurve> curves;
  for (std::size_t i = 0; i < count; ++i) {
    task.experts.push_back(beside(experts, experts.sessions[i], alignments[i], task.task));
    curves.push_back(task.experts.back().curve);
  }
  task.middle = middle_of(curves), task.middle_expert = experts.middle;
  std::vector<std::vector<double>> forces, distances;
  for (const StrokeCurve& curve : curves)
    forces.push_back(curve.force), distances.push_back(distance_from(task.middle, curve));
  task.force = band_of(forces), task.deviation = band_of(distances);
  return experts;
}

/// Drops the attempts that failed; the numbers of those that follow stay, as they are the trainee's.
void drop(std::vector<Attempt>& attempts, const std::vector<Errors>& failures) {
  std::vector<Attempt> kept;
  for (std::size_t i = 0; i < attempts.size(); ++i)
    if (failures[i].empty()) kept.push_back(std::move(attempts[i]));
  attempts = std::move(kept);
}

/// Remarks attempts that hold the same motion and forces as another session: a copy under another name counts twice.
void remark_copies(TaskResult& task) {
  std::map<std::uint64_t, std::string> seen;
  for (auto* all : {&task.experts, &task.attempts})
    for (Attempt& attempt : *all) {
      const auto [first, is_new] = seen.emplace(attempt.motion_hash, attempt.session.file);
      if (!is_new) attempt.remarks.push_back("has the same motion and forces as " + first->second);
    }
}

std::vector<FoundSession> of_task(const std::vector<FoundSession>& all, std::size_t task) {
  std::vector<FoundSession> found;
  std::ranges::copy_if(all, std::back_inserter(found), [&](const FoundSession& s) { return s.task == task; });
  return found;
}

}  // namespace

const compare::SessionValue& Attempt::value_of(const std::string& key) const {
  const auto found = std::ranges::find_if(values, [&](const SessionValue& v) { return key == v.measure->key; });
  CTPM_CHECK(found != values.end(), "a measure of the table");
  return *found;
}

std::vector<double> TaskResult::expert_values(std::size_t measure) const {
  std::vector<double> values;
  for (const Attempt& expert : experts)
    if (expert.values[measure].value) values.push_back(*expert.values[measure].value);
  return values;
}

std::vector<const Attempt*> TaskResult::attempts_of(const std::string& person) const {
  std::vector<const Attempt*> of_person;
  for (const Attempt& attempt : attempts)
    if (attempt.session.person == person) of_person.push_back(&attempt);
  return of_person;
}

bool TaskResult::has_marks() const {
  return std::ranges::any_of(task.marks, [](const auto& m) { return m.pass_at_least || m.pass_at_most; });
}

std::optional<bool> judge(const std::vector<SessionValue>& values, const scenes::TaskSpec& task,
                          std::vector<std::string>& missed) {
  bool any = false;
  for (const scenes::MarkSpec& mark : task.marks) {
    if (!mark.pass_at_least && !mark.pass_at_most) continue;
    any = true;
    const auto found =
        std::ranges::find_if(values, [&](const SessionValue& value) { return mark.measure == value.measure->key; });
    const std::optional<double> value = found != values.end() ? found->value : std::nullopt;
    if (!value || (mark.pass_at_least && *value < *mark.pass_at_least) ||
        (mark.pass_at_most && *value > *mark.pass_at_most))
      missed.push_back(mark.measure);
  }
  return any ? std::optional(missed.empty()) : std::nullopt;
}

Errors find_hard_marks(const TaskResult& task) {
  Errors warnings;
  for (const scenes::MarkSpec& mark : task.task.marks) {
    std::size_t missed = 0;
    std::vector<double> values;
    for (const Attempt& expert : task.experts) {
      missed += std::ranges::count(expert.missed, mark.measure) > 0;
      if (const auto& value = expert.value_of(mark.measure).value) values.push_back(*value);
    }
    if (missed == 0 || 2 * missed < task.experts.size()) continue;
    const auto [least, most] = std::ranges::minmax_element(values);
    warnings.push_back(
        {"task '" + task.task.name + "'",
         std::to_string(missed) + " of its " + std::to_string(task.experts.size()) + " experts miss the pass mark of " +
             mark.measure +
             (values.empty() ? ": it has no value in their sessions"
                             : ", with " + output::short_number(*least, 3) + " to " + output::short_number(*most, 3)),
         "whoever is as good as they are fails"});
  }
  return warnings;
}

CourseFindings find_hard_marks(const scenes::CourseSpec& course) {
  CourseFindings findings;
  const Result<Gathered> gathered = gather_experts(course);
  append(findings.errors, gathered);
  if (!gathered) return findings;
  for (std::size_t i = 0; i < course.tasks.size(); ++i) {
    TaskResult task;
    task.task = course.tasks[i];
    const Result<Experts> experts = measure_experts(task, of_task(gathered->experts, i), {}, [] {});
    append(findings.errors, experts);
    if (experts) append(findings.warnings, find_hard_marks(task));
  }
  return findings;
}

std::optional<double> share_no_better(double value, const std::vector<double>& others, compare::Direction direction,
                                      double target) {
  if (others.empty()) return std::nullopt;
  const auto badness = [&](double v) {
    return direction == compare::Direction::lower    ? v
           : direction == compare::Direction::higher ? -v
                                                     : std::abs(v - target);
  };
  return double(std::ranges::count_if(others, [&](double other) { return badness(other) >= badness(value); })) /
         double(others.size());
}

Result<Cohort> measure_cohort(const scenes::CourseSpec& course, const std::string& trainees,
                              const CohortOptions& options) {
  Result<Gathered> gathered = gather(course, trainees);
  if (!gathered) return gathered.errors();
  Cohort cohort{
      .course = course, .tasks = {}, .trainees = {}, .left_out = gathered->left_out, .damaged = gathered->damaged};
  const auto total = std::int64_t(gathered->experts.size() + gathered->trainees.size());
  std::int64_t done = 0;
  std::mutex telling;
  const auto tell = [&] {
    const std::lock_guard lock(telling);
    if (++done; options.progress) options.progress(done, total);
  };
  Errors errors;
  std::set<std::string> people;
  bool replays = true;
  for (std::size_t i = 0; i < course.tasks.size(); ++i) {
    TaskResult& task = cohort.tasks.emplace_back();
    task.task = course.tasks[i];
    Result<Experts> experts = measure_experts(task, of_task(gathered->experts, i), options, tell);
    if (!experts) {
      append(errors, experts);
      continue;
    }
    const std::vector<FoundSession> found = of_task(gathered->trainees, i);
    task.attempts.resize(found.size());
    std::vector<Errors> failures(found.size());
    parallel::Team(options.threads).for_each(int(found.size()), [&](int at) {
      const auto k = std::size_t(at);
      const Result<ReadSession> read = read_session(found[k], task, options);
      if (read)
        task.attempts[k] = beside(*experts, *read, alignments_from(experts->sessions, *read), task.task);
      else
        failures[k] = read.errors();
      tell();
    });
    for (const Errors& failure : failures) append(cohort.damaged, failure);
    drop(task.attempts, failures);
    remark_copies(task);
    for (const auto* all : {&task.experts, &task.attempts})
      for (const Attempt& attempt : *all)
        replays = replays && std::ranges::none_of(attempt.remarks, [](const std::string& remark) {
                    return remark.starts_with("does not replay") || remark.starts_with("could not be verified");
                  });
    for (const Attempt& attempt : task.attempts) people.insert(attempt.session.person);
  }
  if (people.empty()) append(errors, cohort.damaged);
  if (!errors.empty()) return errors;
  cohort.trainees.assign(people.begin(), people.end());
  cohort.is_verified = options.verify && replays;
  return cohort;
}

}  // namespace ctpm::cohort

#pragma once

#include <arpa/inet.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>

#include <chrono>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "tests/studio/sweep/sweep_files.h"

namespace ctpm::testing {

/// A real Slurm of one node on this machine: munged, slurmctld and slurmd with folders and ports of their own. The
/// processes that jobs leave behind become children of this one, so that a whole node can be killed.
class Cluster {
 public:
  /// Why there can be none here; empty if there can.
  static std::string why_not() {
    if (geteuid() != 0) return "Slurm's daemons need root here";
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol"})
      if (path_of(program).empty()) return std::string(program) + " is not installed (Debian's slurm-wlm)";
    return "";
  }

  explicit Cluster(int most_elements) {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    std::filesystem::create_directories(path() / "state");
    std::filesystem::create_directories(path() / "spool");
    write_key();
    write_settings(most_elements);
    setenv("SLURM_CONF", (path() / "slurm.conf").c_str(), 1);
    const std::string folder = path().string();
    start("munged", {"munged", "--foreground", "--force", "--key-file=" + folder + "/munge.key",
                     "--socket=" + folder + "/munge.socket", "--pid-file=" + folder + "/munged.pid",
                     "--log-file=" + folder + "/munged.log", "--seed-file=" + folder + "/munge.seed"});
    start_controller();
    start_node();
  }
  ~Cluster() {
    for (const auto& [name, process] : daemons_) ::kill(process, SIGKILL);
    kill_all_below(getpid());
    unsetenv("SLURM_CONF");
  }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  /// Whether the node can take jobs, within a minute.
  bool is_ready() const {
    return within_a_minute([&] { return output_of({"sinfo", "-h", "-o", "%T"}).find("idle") == 0; });
  }

  void start_controller() { start("slurmctld", {"slurmctld", "-D", "-f", (path() / "slurm.conf").string()}); }
  /// With -b the node says that it has booted anew, as one does that was killed as a whole.
  void start_node() { start("slurmd", {"slurmd", "-b", "-D", "-N", "node", "-f", (path() / "slurm.conf").string()}); }
  /// Kills the controller alone.
  void kill_controller() { end("slurmctld"); }
  /// Kills slurmd and everything that runs under it: the node is gone.
  void kill_node() {
    const pid_t node = daemons_.at("slurmd");
    std::set<pid_t> spared;
    for (const auto& [name, process] : daemons_)
      if (name != "slurmd") spared.insert(process);
    kill_all_below(node);
    end("slurmd");
    for (const pid_t child : children_of(getpid()))
      if (!spared.contains(child)) kill_all_below(child), ::kill(child, SIGKILL), ::waitpid(child, nullptr, 0);
  }

  /// What an administrator does after a crash of the controller: where jobs ran that it had started after it had last
  /// saved its state, Slurm drains the node and holds the jobs.
  void tidy_up() const {
    if (output_of({"sinfo", "-h", "-o", "%T"}).find("drain") == 0)
      output_of({"scontrol", "update", "NodeName=node", "State=RESUME"});
    for (const std::string& line : lines_of(output_of({"squeue", "-h", "-r", "-t", "PD", "-o", "%A %r"})))
      if (line.find("held") != std::string::npos) output_of({"scontrol", "release", line.substr(0, line.find(' '))});
  }

  template <class Condition>
  static bool within_a_minute(const Condition& condition) {
    constexpr int kTries = 240;
    for (int i = 0; i < kTries; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
    return false;
  }

  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  static std::string path_of(const std::string& program) {
    for (const char* folder : {"/usr/bin/", "/usr/sbin/"})
      if (std::filesystem::exists(folder + program)) return folder + program;
    return "";
  }
  std::string output_of(const std::vector<std::string>& command) const { return run(command, path()).out; }

  static std::vector<pid_t> children_of(pid_t parent) {
    std::ifstream file("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
    std::vector<pid_t> children;
    for (pid_t child = 0; file >> child;) children.push_back(child);
    return children;
  }
  static void kill_all_below(pid_t parent) {
    for (const pid_t child : children_of(parent)) kill_all_below(child), ::kill(child, SIGKILL);
  }

  static int free_port() {
    const int listener = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    bind(listener, reinterpret_cast<sockaddr*>(&address), length);
    getsockname(listener, reinterpret_cast<sockaddr*>(&address), &length);
    close(listener);
    return ntohs(address.sin_port);
  }

  void write_key() const {
    std::random_device random;
    std::string key;
    while (key.size() < 1024) key += char(random());
    write(path() / "munge.key", key);
    std::filesystem::permissions(path() / "munge.key", std::filesystem::perms::owner_read);
  }

  void write_settings(int most_elements) const {
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    const std::string name = host, folder = path().string();
    write(path() / "slurm.conf",
          "ClusterName=ctpm\nSlurmctldHost=" + name + "(127.0.0.1)\nSlurmUser=root\nAuthType=auth/munge\n" +
              "AuthInfo=socket=" + folder + "/munge.socket,cred_expire=5\nCredType=cred/munge\nStateSaveLocation=" +
              folder + "/state\nSlurmdSpoolDir=" + folder + "/spool\nSlurmctldPidFile=" + folder +
              "/slurmctld.pid\nSlurmdPidFile=" + folder + "/slurmd.pid\nSlurmctldPort=" + std::to_string(free_port()) +
              "\nSlurmdPort=" + std::to_string(free_port()) +
              "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\n"
              "SelectTypeParameters=CR_CPU\nJobAcctGatherType=jobacct_gather/none\n"
              "AccountingStorageType=accounting_storage/none\nReturnToService=2\nSlurmdTimeout=5\nSlurmctldTimeout=5\n"
              "KillWait=1\nMessageTimeout=2\nBatchStartTimeout=1\nMpiDefault=none\nMaxArraySize=" +
              std::to_string(most_elements) +
              "\nSchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0\n"
              "NodeName=node NodeHostname=" +
              name + " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\nPartitionName=all Nodes=ALL Default=YES\n");
  }

  void start(const std::string& name, std::vector<std::string> command) {
    command.front() = path_of(command.front());
    const std::string log = (path() / (name + ".out")).string();
    const pid_t child = fork();
    if (child == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const int file = open(log.c_str(), O_CREAT | O_APPEND | O_WRONLY, 0600);
      dup2(file, STDOUT_FILENO), dup2(file, STDERR_FILENO);
      std::vector<char*> argv;
      for (std::string& argument : command) argv.push_back(argument.data());
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(127);
    }
    daemons_[name] = child;
  }
  void end(const std::string& name) {
    ::kill(daemons_.at(name), SIGKILL);
    ::waitpid(daemons_.at(name), nullptr, 0);
    daemons_.erase(name);
  }

  TemporaryFolder folder_;
  std::map<std::string, pid_t> daemons_;
};

}  // namespace ctpm::testing

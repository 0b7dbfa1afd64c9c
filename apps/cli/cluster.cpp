// `mansard cluster SCHEDULER --shares N -o FOLDER -- reconstruct …`: the job scripts of a run over several machines.
#include <sys/wait.h>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/shell_word.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/files.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ClusterRequest {
  std::string scheduler, out, image = "mansard";
  std::vector<std::string> command;
  std::size_t shares = 0, cpus = 2;
  std::string memory = "4G";
  bool submit = false, overwrite = false;
};

auto program() -> std::string {
  std::error_code failure;
  const auto own = fs::read_symlink("/proc/self/exe", failure);
  return failure ? "mansard" : own.string();
}

/// The command of a share or of the merge; `more` is added as it is.
auto line(const ClusterRequest& request, const std::string& program, const std::string& more) -> std::string {
  std::string out = quoted(program);
  for (const auto& word : request.command) out += " " + quoted(word);
  return out + more;
}

auto shares_of(const ClusterRequest& request, const std::string& index) -> std::string {
  return " --shares " + std::to_string(request.shares) + " --share " + index;
}

struct Script {
  std::string name, text;
  bool runs = true;  ///< is a program
};

/// Where the commands are run, so that relative paths mean what they mean here.
auto here() -> std::string {
  std::error_code failure;
  return "cd " + quoted(fs::current_path(failure).string()) + "\n";
}

/// Some buildings may have fallen back (exit code 1): no reason for a scheduler to call the job failed.
constexpr auto accept_fallbacks = " || [ $? -eq 1 ]\n";

auto slurm(const ClusterRequest& request, const fs::path& folder) -> std::vector<Script> {
  const std::string from = fs::absolute(folder).lexically_normal().string();
  const auto head = [&](const std::string& name, const std::string& log) {
    return "#!/bin/bash\n#SBATCH --job-name=mansard-" + name + "\n#SBATCH --output=\"" + from + "/" + log +
           "\"\n#SBATCH --cpus-per-task=" + std::to_string(request.cpus) + "\n#SBATCH --mem=" + request.memory +
           "\n#SBATCH --requeue\n";
  };
  const std::string jobs = " -j \"${SLURM_CPUS_PER_TASK:-1}\"";
  return {{"share.sh", head("share", "share-%a.log") + "#SBATCH --array=1-" + std::to_string(request.shares) +
                           "\n# A share that was stopped goes on from the blocks that it has kept.\nset -e\n" + here() +
                           line(request, program(), jobs + shares_of(request, "\"$SLURM_ARRAY_TASK_ID\"")) + "\n"},
          {"merge.sh", head("merge", "merge.log") + "# All blocks are kept by now; this writes the models.\nset -e\n" +
                           here() + line(request, program(), jobs) + accept_fallbacks},
          {"submit.sh", "#!/bin/bash\n# Submits the shares, and the merge after the last of them.\nset -e\ncd " +
                            quoted(from) +
                            "\nshares=$(sbatch --parsable share.sh)\nmerge=$(sbatch --parsable "
                            "--dependency=afterok:\"$shares\" merge.sh)\necho \"shares: job $shares, merge: job "
                            "$merge\"\n"}};
}

auto parallel(const ClusterRequest& request) -> std::vector<Script> {
  return {{"run.sh",
           "#!/bin/bash\n# GNU parallel makes the shares, as many at a time as -j says (-j 4, or --sshlogin "
           "for other machines);\n# a job that is stopped can be started again. Then the models are written.\n"
           "set -e\n" +
               here() + "seq " + std::to_string(request.shares) + " | parallel --halt soon,fail=1 --retries 3 \"$@\" " +
               quoted(line(request, program(), " -q" + shares_of(request, "{}"))) + "\n" +
               line(request, program(), "") + accept_fallbacks}};
}

/// A string as YAML takes it in double quotes.
auto yaml(const std::string& text) -> std::string {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

auto kubernetes(const ClusterRequest& request) -> std::vector<Script> {
  const auto job = [&](const std::string& name, const std::string& indexed, const std::string& command) {
    return "apiVersion: batch/v1\nkind: Job\nmetadata:\n  name: mansard-" + name + "\nspec:\n" + indexed +
           "  backoffLimit: 12\n  template:\n    spec:\n      restartPolicy: Never\n      containers:\n"
           "      - name: mansard\n        image: " +
           yaml(request.image) + "\n        workingDir: /data\n        command: [\"/bin/sh\", \"-c\", " +
           yaml(command) + "]\n        resources:\n          requests: {cpu: \"" + std::to_string(request.cpus) +
           "\", memory: " + yaml(request.memory + "i") +
           "}\n        volumeMounts:\n        - {name: data, mountPath: /data}\n      volumes:\n      - name: data\n"
           "        persistentVolumeClaim: {claimName: mansard-data}\n";
  };
  const std::string count = std::to_string(request.shares);
  return {{"shares.yaml",
           "# Inputs and output lie on the volume claim mansard-data, which all pods mount at /data.\n" +
               job("shares", "  completionMode: Indexed\n  completions: " + count + "\n  parallelism: " + count + "\n",
                   line(request, "mansard", shares_of(request, "$((JOB_COMPLETION_INDEX + 1))"))),
           false},
          {"merge.yaml",
           "# After shares.yaml: kubectl wait --for=condition=complete --timeout=-1s job/mansard-shares\n" +
               job("merge", "", line(request, "mansard", " || [ $? -eq 1 ]")),
           false}};
}

auto check(const ClusterRequest& request) -> base::Result<void> {
  if (request.command.empty() || request.command.front() != "reconstruct")
    return base::error("usage",
                       "expected '--' and a whole command to be shared: -- reconstruct MESH... FOOTPRINTS -o OUTDIR");
  for (const auto& word : request.command)
    if (word == "--share" || word == "--shares" || word.starts_with("--share=") || word.starts_with("--shares="))
      return base::error("usage", "the shares are added to the command; leave this out of it", word);
  if (request.submit && request.scheduler != "slurm")
    return base::error("usage", "only jobs for slurm can be submitted", "--submit");
  return {};
}

auto cluster(const ClusterRequest& request) -> int {
  if (auto right = check(request); !right) return give_up(right.errors());
  if (auto ready = prepare(request.out, request.overwrite); !ready) return give_up(ready.errors());
  const auto scripts = request.scheduler == "slurm"      ? slurm(request, request.out)
                       : request.scheduler == "parallel" ? parallel(request)
                                                         : kubernetes(request);
  std::vector<base::FileToWrite> files;
  for (const auto& script : scripts) files.push_back({fs::path(request.out) / script.name, script.text});
  if (auto written = base::write_files(files); !written) return give_up(written.errors());
  for (const auto& script : scripts) {
    std::error_code failure;
    const auto path = fs::path(request.out) / script.name;
    if (script.runs)
      fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                      fs::perm_options::add, failure);
    std::printf("%s\n", path.c_str());
  }
  if (!request.submit) return all_done;
  std::fflush(stdout);
  const int status = std::system(quoted((fs::path(fs::absolute(request.out)) / "submit.sh").string()).c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return all_done;
  return give_up(base::error("cluster-submit",
                             "the jobs could not be submitted; see the message above, then run it "
                             "again",
                             (fs::path(request.out) / "submit.sh").string()));
}

}  // namespace

auto cluster_verb(CLI::App& app) -> Verb {
  auto* verb = add_verb(app, "cluster");
  auto request = std::make_shared<ClusterRequest>();
  verb->add_option("SCHEDULER", request->scheduler, "slurm, parallel (GNU parallel) or kubernetes")
      ->required()
      ->check(CLI::IsMember({"slurm", "parallel", "kubernetes"}));
  verb->add_option("COMMAND", request->command, "After '--': the whole command that is to be shared")
      ->type_name("-- reconstruct ...");
  verb->add_option("-o,--output", request->out, "Folder for the job scripts")->required()->type_name("FOLDER");
  verb->add_option("--shares", request->shares, "Number of shares that the work is divided into")
      ->required()
      ->check(CLI::Range(1, 100000));
  verb->add_option("--cpus", request->cpus, "Number of processors for each share")->check(CLI::Range(1, 1024));
  verb->add_option("--memory", request->memory, "Memory for each share, as the scheduler spells it");
  verb->add_option("--image", request->image, "Container image, for kubernetes");
  verb->add_flag("--submit", request->submit, "Submit the jobs too, for slurm");
  verb->add_flag("--overwrite", request->overwrite, "Replace scripts that already exist");
  return {verb, [request] { return cluster(*request); }};
}

}  // namespace mansard::cli

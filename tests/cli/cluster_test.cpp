// Job scripts: what they say, and that they do it where their scheduler is installed.
#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;

class Cluster : public Command {
 protected:
  [[nodiscard]] auto reconstruction() const -> std::string {
    return "-- reconstruct " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out") + " -q";
  }
};

TEST_F(Cluster, writes_a_job_array_and_a_merge_that_depends_on_it) {
  const auto made = run("cluster slurm --shares 12 --cpus 3 --memory 6G -o " + at("jobs") + " " + reconstruction());
  ASSERT_EQ(made.exit, 0) << made.err;
  const auto share = read(at("jobs") + "/share.sh"), submit = read(at("jobs") + "/submit.sh");
  EXPECT_THAT(share, HasSubstr("#SBATCH --array=1-12\n"));
  EXPECT_THAT(share, HasSubstr("#SBATCH --cpus-per-task=3\n"));
  EXPECT_THAT(share, HasSubstr("#SBATCH --mem=6G\n"));
  EXPECT_THAT(share, HasSubstr(" --shares 12 --share \"$SLURM_ARRAY_TASK_ID\"\n"));
  EXPECT_THAT(read(at("jobs") + "/merge.sh"), testing::Not(HasSubstr("--share")));
  EXPECT_THAT(submit, HasSubstr("--dependency=afterok:\"$shares\" merge.sh"));
  for (const auto* name : {"share.sh", "merge.sh", "submit.sh"}) {
    EXPECT_EQ(std::system(("bash -n " + at("jobs") + "/" + name).c_str()), 0);
    EXPECT_EQ(::access((at("jobs") + "/" + name).c_str(), X_OK), 0);
  }
}

TEST_F(Cluster, has_scripts_that_make_the_models_when_they_are_run_by_hand) {
  ASSERT_EQ(run("cluster slurm --shares 2 -o " + at("jobs") + " " + reconstruction()).exit, 0);
  for (const auto* index : {"1", "2"})
    EXPECT_EQ(std::system(("SLURM_ARRAY_TASK_ID=" + std::string(index) + " " + at("jobs") + "/share.sh").c_str()), 0);
  EXPECT_FALSE(fs::exists(at("out") + "/model.city.json"));
  EXPECT_EQ(std::system((at("jobs") + "/merge.sh >/dev/null").c_str()), 0);
  EXPECT_TRUE(fs::exists(at("out") + "/model.city.json"));
}

TEST_F(Cluster, keeps_words_with_spaces_and_quotes_together) {
  put("a house's scan.obj", house);
  ASSERT_EQ(run("cluster slurm --shares 1 -o " + at("jobs") + " -- reconstruct \"" + at("a house's scan.obj") + "\" " +
                at("house.geojson") + " -o " + at("out") + " -q")
                .exit,
            0);
  EXPECT_EQ(std::system(("SLURM_ARRAY_TASK_ID=1 " + at("jobs") + "/share.sh").c_str()), 0);
}

TEST_F(Cluster, runs_with_gnu_parallel) {
  if (std::system("command -v parallel >/dev/null 2>&1") != 0) GTEST_SKIP() << "GNU parallel is not installed";
  ASSERT_EQ(run("cluster parallel --shares 3 -o " + at("jobs") + " " + reconstruction()).exit, 0);
  EXPECT_EQ(std::system((at("jobs") + "/run.sh -j 2 >/dev/null 2>" + at("stderr")).c_str()), 0) << read(at("stderr"));
  EXPECT_TRUE(fs::exists(at("out") + "/model.city.json"));
}

TEST_F(Cluster, writes_an_indexed_job_for_kubernetes) {
  ASSERT_EQ(
      run("cluster kubernetes --shares 5 --image registry/mansard:1 -o " + at("jobs") + " " + reconstruction()).exit,
      0);
  const auto shares = read(at("jobs") + "/shares.yaml");
  EXPECT_THAT(shares, HasSubstr("completionMode: Indexed\n  completions: 5\n  parallelism: 5\n"));
  EXPECT_THAT(shares, HasSubstr("--share $((JOB_COMPLETION_INDEX + 1))"));
  EXPECT_THAT(shares, HasSubstr("image: \"registry/mansard:1\""));
  EXPECT_THAT(read(at("jobs") + "/merge.yaml"), HasSubstr("name: mansard-merge"));
}

TEST_F(Cluster, refuses_what_is_no_command_to_share) {
  const auto common = "cluster slurm --shares 2 -o " + at("jobs");
  EXPECT_EQ(run(common).exit, 2);
  EXPECT_EQ(run(common + " -- extrude x").exit, 2);
  EXPECT_EQ(run(common + " " + reconstruction() + " --shares 3").exit, 2);
  EXPECT_EQ(run("cluster kubernetes --shares 2 --submit -o " + at("jobs") + " " + reconstruction()).exit, 2);
  EXPECT_FALSE(fs::exists(at("jobs")));
}

}  // namespace
}  // namespace mansard::cli

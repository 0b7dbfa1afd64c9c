// `mansard report RUN [-o OUT.html]`: a page about a run, to read and to print.
#include <chrono>
#include <cstdio>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/pipeline/run_report.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ReportRequest {
  std::string folder, out, changes, title, date;
  std::vector<std::string> scans, reviews;
  std::size_t worst = 10, jobs = 0;
  bool no_scan = false, overwrite = false, quiet = false;
};

/// "2026-11-28", UTC.
auto today() -> std::string {
  const std::chrono::year_month_day day{std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now())};
  const auto two = [](unsigned n) { return (n < 10 ? "0" : "") + std::to_string(n); };
  return std::to_string(static_cast<int>(day.year())) + "-" + two(static_cast<unsigned>(day.month())) + "-" +
         two(static_cast<unsigned>(day.day()));
}

auto report(const ReportRequest& request, const base::Cancel& cancel) -> int {
  const fs::path out = request.out.empty() ? fs::path(request.folder) / run_report_name : fs::path(request.out);
  if (request.no_scan && !request.scans.empty())
    return give_up(base::error("usage", "leave one of --scan and --no-scan out", "--no-scan"));
  std::vector<fs::path> inputs{request.scans.begin(), request.scans.end()};
  inputs.insert(inputs.end(), request.reviews.begin(), request.reviews.end());
  if (auto spared = spare_inputs({out}, inputs); !spared) return give_up(spared.errors());
  std::error_code status;
  if (!request.out.empty() || fs::is_directory(request.folder, status))  // else there is no run
    if (auto free = file_free(out, request.overwrite); !free) return give_up(free.errors());
  Progress progress(request.quiet);
  Common common;
  common.jobs = request.jobs;
  const auto run = start(common, 0, cancel, progress);
  const auto made = pipeline::run_report(request.folder,
                                         {{request.scans.begin(), request.scans.end()},
                                          !request.no_scan,
                                          {request.reviews.begin(), request.reviews.end()},
                                          request.changes,
                                          request.worst,
                                          request.title,
                                          request.date.empty() ? today() : request.date},
                                         run);
  if (!made) return give_up(made.errors());
  for (const auto& warning : made->warnings) progress.say(base::to_string(warning));
  if (auto written = base::write_files({{out, made->html}}, &cancel); !written) return give_up(written.errors());
  std::printf("%s\n", out.c_str());
  return all_done;
}

}  // namespace

auto report_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "report");
  auto request = std::make_shared<ReportRequest>();
  verb->add_option("RUN", request->folder, "Output folder of 'mansard reconstruct', or the folder of a project's run")
      ->required()
      ->type_name("RUN");
  verb->add_option("-o,--output", request->out, "The page; without it report.html in the folder of the run")
      ->type_name("OUT.html");
  verb->add_option("--worst", request->worst, "Number of models with a picture, those that are least sure first")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1000}))
      ->capture_default_str()
      ->type_name("N");
  verb->add_option("--review", request->reviews,
                   "Decisions of people: review.json of projects, or their folders; without it, those of the project "
                   "that the run belongs to, or that the models have as attributes")
      ->type_name("FILE...");
  verb->add_option("--changes", request->changes,
                   "What has changed: changes.json of 'mansard compare', or the folder that it wrote")
      ->type_name("FILE");
  verb->add_option("--scan", request->scans,
                   "Scan that the models were made from; without it, that of the run where it is still there")
      ->type_name("FILE...");
  verb->add_flag("--no-scan", request->no_scan, "Draw the models without the scan, which need not be read then");
  verb->add_option("--title", request->title, "Title of the page; without it, the name of the run")->type_name("TEXT");
  verb->add_option("--date", request->date, "Date on the page; without it, today's (UTC)")->type_name("TEXT");
  verb->add_flag("--overwrite", request->overwrite, "Replace the page if it already exists");
  add_jobs(*verb, request->jobs);
  verb->add_flag("-q,--quiet", request->quiet, "Print no progress and no warnings");
  return {verb, [request, &cancel] { return report(*request, cancel); }};
}

}  // namespace mansard::cli

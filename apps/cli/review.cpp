// `mansard review REVIEW… [-o OUT]`: decisions of several people counted, and merged into one file.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/report/review.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ReviewVerbRequest {
  std::vector<std::string> inputs;
  std::string out;
  bool overwrite = false, quiet = false;
};

using Counts = std::array<std::size_t, report::verdict_names.size()>;

auto in_words(const Counts& counts) -> std::string {
  std::string out;
  for (std::size_t v = 0; v < counts.size(); ++v)
    ((out += v == 0 ? "" : ", ") += std::to_string(counts[v]) + ' ') += report::verdict_names[v];
  return out;
}

auto by_whom(const report::Decision& one) -> std::string {
  return std::string(report::to_string(one.verdict)) + " (" +
         (one.reviewer.empty() ? std::string("no name") : base::on_one_line(one.reviewer)) + ", " + one.time + ")";
}

void print_counts(const report::Decisions& decisions) {
  Counts all{};
  std::map<std::string, Counts> of;
  for (const auto& [building, one] : decisions) {
    ++all[static_cast<std::size_t>(one.verdict)];
    ++of[one.reviewer][static_cast<std::size_t>(one.verdict)];
  }
  std::printf("%zu %s: %s\n", decisions.size(), decisions.size() == 1 ? "decision" : "decisions",
              in_words(all).c_str());
  for (const auto& [reviewer, counts] : of)
    std::printf("  %s: %s\n", reviewer.empty() ? "no name" : base::on_one_line(reviewer).c_str(),
                in_words(counts).c_str());
}

auto review(const ReviewVerbRequest& request) -> int {
  if (!request.out.empty()) {
    std::vector<fs::path> inputs;
    for (const auto& input : request.inputs) {
      const fs::path path(input);
      std::error_code status;
      inputs.push_back(fs::is_directory(path, status) ? path / report::review_file : path);
    }
    if (auto spared = spare_inputs({request.out}, inputs); !spared) return give_up(spared.errors());
    if (auto free = file_free(request.out, request.overwrite); !free) return give_up(free.errors());
  }
  report::Decisions all;
  std::vector<report::MergedReview::Conflict> conflicts;
  for (const auto& input : request.inputs) {
    const auto own = report::read_review(input);
    if (!own) return give_up(own.errors());
    auto both = report::merged(all, *own);
    all = std::move(both.decisions);
    conflicts.insert(conflicts.end(), both.conflicts.begin(), both.conflicts.end());
  }
  if (!request.quiet) {
    print_counts(all);
    for (const auto& [kept, dropped] : conflicts)
      std::printf("%s: %s is kept, %s is not\n", base::on_one_line(kept.building).c_str(), by_whom(kept).c_str(),
                  by_whom(dropped).c_str());
  }
  if (request.out.empty()) return all_done;
  const auto text = report::review_text(all);
  if (auto written = base::write_files({{request.out, text}}); !written) return give_up(written.errors());
  std::printf("%s\n", request.out.c_str());
  return all_done;
}

}  // namespace

auto review_verb(CLI::App& app) -> Verb {
  auto* verb = add_verb(app, "review");
  auto request = std::make_shared<ReviewVerbRequest>();
  verb->add_option("REVIEWS", request->inputs, "Decisions: review.json of projects, or the folders of projects")
      ->required()
      ->type_name("REVIEW...");
  verb->add_option("-o,--output", request->out,
                   "File for all decisions together. Where two decided on one building, the later decision counts")
      ->type_name("OUT.json");
  verb->add_flag("--overwrite", request->overwrite, "Replace the output if it already exists");
  verb->add_flag("-q,--quiet", request->quiet, "Print the path of the output only");
  return {verb, [request] { return review(*request); }};
}

}  // namespace mansard::cli

// `mansard status OUT`.
#include <cstdio>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/run_folder.hpp"
#include "apps/cli/verbs.hpp"

namespace mansard::cli {

auto status_verb(CLI::App& app) -> Verb {
  struct Request {
    std::string out;
    bool json = false;
  };
  auto* verb = add_verb(app, "status");
  auto request = std::make_shared<Request>();
  verb->add_option("OUT", request->out, "Output folder of the run, or its output file")->required()->type_name("OUT");
  verb->add_flag("--json", request->json, "Print JSON");
  return {verb, [request] {
            const auto status = status_json(request->out);
            if (!status) return give_up(status.errors());
            std::fputs((request->json ? *status : status_in_words(*status)).c_str(), stdout);
            return static_cast<int>(all_done);
          }};
}

}  // namespace mansard::cli

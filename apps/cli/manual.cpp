// `mansard manual`: the manual page, made of what the verbs take, for man(1).
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string_view>

#include "apps/cli/exit.hpp"
#include "apps/cli/grammar.hpp"
#include "apps/cli/verbs.hpp"

namespace mansard::cli {
namespace {

/// Bytes of UTF-8 to the next code point; what is no UTF-8 becomes a question mark.
auto next_code(std::string_view text, std::size_t& at) -> unsigned {
  const auto first = static_cast<unsigned char>(text[at++]);
  const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
  unsigned code = more == 3 ? first & 0x07U : more == 2 ? first & 0x0FU : more == 1 ? first & 0x1FU : first;
  for (int i = 0; i < more && at < text.size(); ++i)
    code = code << 6U | (static_cast<unsigned char>(text[at++]) & 0x3FU);
  return first >= 0x80 && more == 0 ? '?' : code;
}

/// Text as roff takes it: nothing in it is a request or an escape.
auto roff(std::string_view text) -> std::string {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const unsigned code = next_code(text, at);
    std::array<char, 16> escape{};
    if (code == '\\') {
      out += "\\(rs";
    } else if (code == '-') {
      out += "\\-";
    } else if (code == '\'') {
      out += "\\(aq";
    } else if (code == '"') {
      out += "\\(dq";
    } else if (code >= 0x80) {
      std::snprintf(escape.data(), escape.size(), "\\[u%04X]", code);
      out += escape.data();
    } else {
      out += out.empty() && code == '.' ? "\\&." : std::string(1, static_cast<char>(code));
    }
  }
  return out;
}

auto term_text(const Term& term) -> std::string {
  std::string names;
  for (const auto& name : term.names) names += (names.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
  const std::string value = term.value.empty() && term.needs_value ? "WORD" : term.value;
  if (!value.empty()) names += (names.empty() ? "" : " ") + ("\\fI" + roff(value) + "\\fR");
  std::string text = ".TP\n" + names + "\n" + roff(term.meaning);
  // The words of a room's option stand in its meaning already.
  if (term.takes == Takes::words && term.needs_value && term.room.empty() && term.words.size() < 10) {
    std::string words;
    for (const auto& word : term.words)
      if (term.meaning.find(word) == std::string::npos) words += (words.empty() ? "" : ", ") + word;
    if (!words.empty()) text += roff(": " + words);
  }
  return text + "\n";
}

/// verb ARGUMENT… -o OUT [options]
auto form_text(const Form& form) -> std::string {
  std::string text = ".B mansard " + roff(form.verb) + "\n";
  for (const auto& term : form.arguments)
    text += term.required || term.value.find(' ') != std::string::npos ? ".I " + roff(term.value) + "\n"
                                                                       : ".RI [ " + roff(term.value) + " ]\n";
  bool more = false;
  for (const auto& term : form.options) {
    if (!term.required) {
      more = more || term.names.front() != "--help";
      continue;
    }
    text += ".BI " + roff(term.names.back()) + " \" " + roff(term.value) + "\"\n";
  }
  return text + (more ? ".RI [ options ]\n" : "");
}

struct Room {
  std::vector<std::string> verbs;
  std::vector<Term> options;
};

/// In the order of the house, as the verbs have them.
auto rooms_of(const std::vector<Form>& forms) -> std::vector<std::pair<std::string, Room>> {
  std::vector<std::pair<std::string, Room>> rooms;
  for (const auto& form : forms)
    for (const auto& term : form.options) {
      if (term.room.empty()) continue;
      auto at = std::ranges::find(rooms, term.room, &std::pair<std::string, Room>::first);
      if (at == rooms.end()) at = rooms.insert(rooms.end(), {term.room, {}});
      auto& [verbs, options] = at->second;
      if (std::ranges::find(verbs, form.verb) == verbs.end()) verbs.push_back(form.verb);
      if (std::ranges::find(options, term.names, &Term::names) == options.end()) options.push_back(term);
    }
  return rooms;
}

auto listed(const std::vector<std::string>& words) -> std::string {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + ("\\fB" + roff(words[i]) + "\\fR");
  return text;
}

auto page(const CLI::App& app) -> std::string {
  const auto forms = forms_of(app);
  std::string text =
      ".\\\" Made by 'mansard manual' of the lists of options in the program.\n.TH MANSARD 1 \"\" \"mansard " +
      std::string(MANSARD_VERSION) + "\" \"User Commands\"\n.SH NAME\nmansard \\- " +
      "city mesh and footprints to clean, labelled, watertight building models\n.SH SYNOPSIS\n";
  for (const auto& form : forms) text += form_text(form) + ".br\n";
  text +=
      ".B mansard \\-\\-version\n.SH DESCRIPTION\nA noisy city mesh and its building footprints in; clean, watertight, "
      "wall\\-and\\-roof\\-labelled building models out, which stay editable as plan + profiles.\n"
      "Paths of results go to standard output, all else to standard error.\n"
      "The same input, options and seed give the same bytes at any number of threads.\n.SH VERBS\n";
  for (const auto& form : forms) {
    text += ".SS " + roff(form.verb) + "\n" + roff(form.meaning) + ".\n";
    for (const auto& term : form.arguments) text += term_text(term);
    for (const auto& term : form.options)
      if (term.room.empty()) text += term_text(term);
  }
  text +=
      ".SH OPTIONS OF THE ROOMS\nOption \\fIname\\fR of room \\fIroom\\fR is \\fB\\-\\-room\\-name\\fR, with dashes "
      "for "
      "underscores; in the file of \\fB\\-\\-config\\fR, which is TOML, it is \\fIname\\fR in the table "
      "[\\fIroom\\fR].\n"
      "The command line goes before the file, the file before the preset, the preset before the defaults.\n";
  for (const auto& [name, room] : rooms_of(forms)) {
    text += ".SS " + roff(name) + "\nOf " + listed(room.verbs) + ".\n";
    for (const auto& term : room.options) text += term_text(term);
  }
  text += ".SH EXIT STATUS\n";
  for (const auto& exit : exits()) text += ".TP\n\\fB" + std::to_string(exit.code) + "\\fR\n" + roff(exit.when) + "\n";
  text +=
      ".SH DIAGNOSTICS\nAn error is one line on standard error: \\fBmansard: error[\\fIcode\\fB] \\fIsubject\\fB: "
      "\\fImessage\\fR.\n\\fBmansard explain\\fR \\fIcode\\fR says what it means and what to do; without a code, it "
      "lists "
      "them all.\n.SH EXAMPLES\n.nf\nmansard reconstruct mesh.obj footprints.geojson \\-o out \\-\\-picture\n"
      "mansard extrude out/plans.json \\-o edited.city.json\n"
      "mansard simulate \\-\\-block terrace \\-\\-preset oblique\\-aerial \\-o terrace\n.fi\n";
  return text;
}

}  // namespace

auto manual_verb(CLI::App& app) -> Verb {
  auto* verb = app.add_subcommand("manual", "Print the manual page, for 'man -l -'");
  return {verb, [&app] {
            std::fputs(page(app).c_str(), stdout);
            return static_cast<int>(all_done);
          }};
}

}  // namespace mansard::cli

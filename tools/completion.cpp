#include <fmt/format.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "console.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "verbs.hpp"

namespace {

/// " study speed", as the script below puts it together; empty for the command itself.
std::string path_of(const Command::Typable& typable) {
  return typable.verb.empty() ? "" : fmt::format(" {}", fmt::join(typable.verb, " "));
}

/// A script for bash: after each verb its own verbs and options and, behind an option, the words that it takes or
/// files.
std::string bash_completion(const std::vector<Command::Typable>& typables) {
  std::vector<std::string> verbs;
  std::string after_verbs, after_options;
  std::map<std::string, std::set<std::string>> words;
  for (const tribofit::Effect& effect : tribofit::effect_catalogue()) words["--effect"].insert(describe(effect).key);
  for (const Command::Typable& one : typables) {
    if (!one.verb.empty()) verbs.push_back("\"" + path_of(one) + "\"");
    after_verbs += fmt::format("    \"{}\")\n      verbs=\"{}\"\n      options=\"{}\"\n      ;;\n", path_of(one),
                               fmt::join(one.verbs, " "), fmt::join(one.options, " "));
    for (const auto& [option, own] : one.words) words[option].insert(own.begin(), own.end());
  }
  for (const auto& [option, own] : words) {
    after_options += fmt::format("    {}) words=\"{}\" ;;\n", option, fmt::join(own, " "));
  }
  return fmt::format(R"bash(# Completion of identify for bash, made by 'identify completion bash'.
_tribofit() {{
  local word path="" verbs="" options="" words="" typed="${{COMP_WORDS[COMP_CWORD]}}"
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$path $word" in
      {}) path="$path $word" ;;
    esac
  done
  case "$path" in
{}  esac
  case "${{COMP_WORDS[COMP_CWORD-1]}}" in
{}  esac
  if [[ "$words" ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$typed")
  elif [[ "$typed" == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$typed")
  else
    mapfile -t COMPREPLY < <(compgen -W "$verbs" -- "$typed"; compgen -f -- "$typed")
  fi
}}
complete -o filenames -F _tribofit tribofit
case "$(readlink -f "$(type -P identify)")" in
  *im6* | *im7* | *magick*) ;;  # ImageMagick's
  *) complete -o filenames -F _tribofit identify ;;
esac
)bash",
                     fmt::join(verbs, " | "), after_verbs, after_options);
}

}  // namespace

void add_completion(const Command& app) {
  const Command verb = app.add_verb("completion", "Print what a shell needs to complete verbs and options");
  verb.footer(
      "Examples:\n"
      "  source <(identify completion bash)     now; a package installs it for good\n"
      "  identify completion verbs              every verb on a line of its own");
  const auto what = std::make_shared<std::string>("bash");
  verb.add_option("WHAT", *what, "A script for bash (default), or a list of the verbs").one_of({"bash", "verbs"});
  verb.on_run([app, what] {
    const std::vector<Command::Typable> typables = app.typables();
    std::string verbs;
    for (const Command::Typable& one : typables) verbs += fmt::format("{}\n", fmt::join(one.verb, " "));
    print(*what == "bash" ? bash_completion(typables) : verbs);
    return ExitStatus::done;
  });
}

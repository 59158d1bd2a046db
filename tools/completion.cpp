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

/// What a script chooses from: by the verb typed, and by the option before the word.
struct Choices {
  std::vector<std::string> paths;  ///< " study speed", quoted
  std::map<std::string, std::set<std::string>> words;
};

Choices choices_of(const std::vector<Command::Typable>& typables) {
  Choices out;
  for (const tribofit::Effect& effect : tribofit::effect_catalogue())
    out.words["--effect"].insert(describe(effect).key);
  for (const Command::Typable& one : typables) {
    if (!one.verb.empty()) out.paths.push_back("\"" + path_of(one) + "\"");
    for (const auto& [option, own] : one.words) out.words[option].insert(own.begin(), own.end());
  }
  return out;
}

/// A script for zsh, as that for bash.
std::string zsh_completion(const std::vector<Command::Typable>& typables) {
  const Choices choices = choices_of(typables);
  std::string after_verbs, after_options;
  for (const Command::Typable& one : typables) {
    after_verbs += fmt::format("    (\"{}\")\n      verbs=({})\n      options=({})\n      ;;\n", path_of(one),
                               fmt::join(one.verbs, " "), fmt::join(one.options, " "));
  }
  for (const auto& [option, own] : choices.words) {
    after_options += fmt::format("    ({}) offered=({}) ;;\n", option, fmt::join(own, " "));
  }
  return fmt::format(R"zsh(#compdef tribofit identify
# Completion of identify for zsh, made by 'identify completion zsh'.
_tribofit() {{
  local word at=""
  local -a verbs options offered
  for word in "${{(@)words[2,CURRENT-1]}}"; do
    case "$at $word" in
      ({}) at="$at $word" ;;
    esac
  done
  case "$at" in
{}  esac
  case "${{words[CURRENT-1]}}" in
{}  esac
  if (( $#offered )); then
    compadd -a offered
  elif [[ "$PREFIX" == -* ]]; then
    compadd -a options
  else
    compadd -a verbs
    _files
  fi
}}
compdef _tribofit tribofit
case "${{commands[identify]:A}}" in
  (*im6*|*im7*|*magick*) ;;  # ImageMagick's
  (*) compdef _tribofit identify ;;
esac
)zsh",
                     fmt::join(choices.paths, " | "), after_verbs, after_options);
}

/// A script for fish: a line for each verb, its options, and the words of an option.
std::string fish_completion(const std::vector<Command::Typable>& typables) {
  const Choices choices = choices_of(typables);
  std::string lines;
  for (const Command::Typable& one : typables) {
    const std::string here = fmt::format("complete -c $command -n 'test (__tribofit_at) = \"{}\"'", path_of(one));
    if (!one.verbs.empty()) lines += fmt::format("  {} -a '{}'\n", here, fmt::join(one.verbs, " "));
    for (const std::string& option : one.options) {
      const auto words = choices.words.find(option);
      lines += fmt::format("  {} -l {}", here, option.substr(2));
      if (words != choices.words.end()) lines += fmt::format(" -xa '{}'", fmt::join(words->second, " "));
      lines += "\n";
    }
  }
  return fmt::format(R"fish(# Completion of identify for fish, made by 'identify completion fish'.
function __tribofit_at
  set -l at ""
  for word in (commandline -opc)[2..-1]
    switch "$at $word"
      case {}
        set at "$at $word"
    end
  end
  echo "$at"
end
set -l commands tribofit
string match -qr 'im6|im7|magick' -- (realpath (command -s identify; or echo /) 2>/dev/null); or set -a commands identify
for command in $commands
{}end
)fish",
                     fmt::join(choices.paths, " "), lines);
}

/// A script for bash: after each verb its own verbs and options and, behind an option, the words that it takes or
/// files.
std::string bash_completion(const std::vector<Command::Typable>& typables) {
  const Choices choices = choices_of(typables);
  std::string after_verbs, after_options;
  for (const Command::Typable& one : typables) {
    after_verbs += fmt::format("    \"{}\")\n      verbs=\"{}\"\n      options=\"{}\"\n      ;;\n", path_of(one),
                               fmt::join(one.verbs, " "), fmt::join(one.options, " "));
  }
  for (const auto& [option, own] : choices.words) {
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
                     fmt::join(choices.paths, " | "), after_verbs, after_options);
}

}  // namespace

void add_completion(const Command& app) {
  const Command verb = app.add_verb("completion", "Print what a shell needs to complete verbs and options");
  verb.footer(
      "Examples:\n"
      "  source <(identify completion bash)         now; a package installs it for good\n"
      "  source <(identify completion zsh)          the same for zsh\n"
      "  identify completion fish | source          and for fish\n"
      "  identify completion verbs                  every verb on a line of its own");
  const auto what = std::make_shared<std::string>("bash");
  verb.add_option("WHAT", *what, "A script for bash (default), zsh or fish, or a list of the verbs")
      .one_of({"bash", "zsh", "fish", "verbs"});
  verb.on_run([app, what] {
    const std::vector<Command::Typable> typables = app.typables();
    std::string verbs;
    for (const Command::Typable& one : typables) verbs += fmt::format("{}\n", fmt::join(one.verb, " "));
    print(*what == "bash"   ? bash_completion(typables)
          : *what == "zsh"  ? zsh_completion(typables)
          : *what == "fish" ? fish_completion(typables)
                            : verbs);
    return ExitStatus::done;
  });
}

#include <algorithm>

#include "tribofit/friction/effects/all.hpp"
#include "verbs.hpp"

namespace {

// Each asks the command itself, by `completion next`, what may stand where the cursor is.

constexpr const char* kBash = R"bash(# Completion of identify for bash, made by 'identify completion bash'.
_tribofit() {
  local offered word="${COMP_WORDS[COMP_CWORD]}" command="${COMP_WORDS[0]/#\~/$HOME}"
  offered="$("$command" completion next -- "${COMP_WORDS[@]:1:COMP_CWORD-1}" "=$word" 2>/dev/null)"
  mapfile -t COMPREPLY < <(compgen -W "${offered//@files/}" -- "$word"; [[ "$offered" != *@files* ]] || compgen -f -- "$word")
}
complete -o filenames -F _tribofit tribofit
case "$(readlink -f "$(type -P identify)")" in
  *im6* | *im7* | *magick*) ;;  # ImageMagick's
  *) complete -o filenames -F _tribofit identify ;;
esac
)bash";

constexpr const char* kZsh = R"zsh(#compdef tribofit identify
# Completion of identify for zsh, made by 'identify completion zsh'.
_tribofit() {
  local -a offered
  offered=("${(@f)$(${~words[1]} completion next -- "${(@)words[2,CURRENT-1]}" "=${words[CURRENT]}" 2>/dev/null)}")
  compadd -- "${(@)offered:#@files}"
  if (( ${offered[(Ie)@files]} )); then
    _files
  fi
}
compdef _tribofit tribofit
case "${commands[identify]:A}" in
  (*im6*|*im7*|*magick*) ;;  # ImageMagick's
  (*) compdef _tribofit identify ;;
esac
)zsh";

constexpr const char* kFish = R"fish(# Completion of identify for fish, made by 'identify completion fish'.
function __tribofit_next
  set -l before (commandline -opc)
  set -l word (commandline -ct)
  set -l offered ($before[1] completion next -- $before[2..-1] "=$word" 2>/dev/null)
  string match -v @files -- $offered
  contains @files $offered; and __fish_complete_path "$word"
end
set -l commands tribofit
string match -qr 'im6|im7|magick' -- (realpath (command -s identify; or echo /) 2>/dev/null); or set -a commands identify
for command in $commands
  complete -c $command -f -a '(__tribofit_next)'
end
)fish";

/// What may stand at the cursor, a word a line. before: the words before it; word: '=' and as much of it as is typed.
std::string next_words(const Command& app, std::vector<std::string> before) {
  const bool is_option = !before.empty() && before.back().starts_with("=-");
  if (!before.empty()) before.pop_back();
  Command::Offer offer = app.offer_after(before, is_option);
  if (!before.empty() && before.back() == "--effect") {
    offer = {};
    for (const tribofit::Effect& effect : tribofit::effect_catalogue()) offer.words.push_back(describe(effect).key);
  }
  std::sort(offer.words.begin(), offer.words.end());
  if (offer.is_open) offer.words.emplace_back("@files");
  std::string lines;
  for (const std::string& one : offer.words) lines += one + "\n";
  return lines;
}

}  // namespace

void add_completion(const Command& app) {
  const Command verb = app.add_verb("completion", "Print what a shell needs to complete verbs and options",
                                    "Examples:\n"
                                    "  source <(identify completion bash)         now; a package installs it for good\n"
                                    "  source <(identify completion zsh)          the same for zsh\n"
                                    "  identify completion fish | source          and for fish\n"
                                    "  identify completion verbs                  every verb on a line of its own");
  const auto what = std::make_shared<std::string>("bash");
  const auto before = std::make_shared<std::vector<std::string>>();
  verb.add_option("WHAT", *what, "A script for bash (default), zsh or fish, or a list of the verbs")
      .one_of({"bash", "zsh", "fish", "verbs", "next"});
  verb.add_names("WORDS", *before, "Behind 'next', by which the scripts ask: words that are typed");
  verb.on_run([app, what, before] {
    std::string verbs;
    for (const std::string& one : app.verbs()) verbs += one + "\n";
    print(*what == "bash"   ? kBash
          : *what == "zsh"  ? kZsh
          : *what == "fish" ? kFish
          : *what == "next" ? next_words(app, *before)
                            : verbs);
  });
}

#include "tribofit/friction/effects/all.hpp"
#include "tribofit/study/fingerprint.hpp"
#include "verbs.hpp"

using namespace tribofit;

void add_effects(const Command& app) {
  const Command verb =
      app.add_verb("effects", "List the laws and the effects that can be added to them, or explain an effect",
                   "Example:\n  identify effects rate-state");
  const auto key = std::make_shared<std::string>();
  verb.add_option("KEY", *key, "Effect to explain, KEY or KEY:FORM");
  verb.on_run([key] {
    const TerminalOptions options = terminal_options(Settings(), {});
    if (!key->empty()) {
      const Effect effect = effect_named(*key);
      const Fingerprint shown = fingerprint(effect);
      print(render_terminal(effect_report(describe(effect), &shown, options), options));
      return;
    }
    std::vector<EffectInfo> effects;
    for (const Effect& effect : effect_catalogue()) effects.push_back(describe(effect));
    print(render_terminal(laws_report(law_catalogue()), options) + "\n" +
          render_terminal(effects_report(effects), options));
  });
}

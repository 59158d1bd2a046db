#include <memory>
#include <string>
#include <vector>

#include "console.hpp"
#include "options.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/oscillator/fingerprint.hpp"
#include "tribofit/report/fingerprint.hpp"
#include "tribofit/report/terminal.hpp"
#include "verbs.hpp"

using namespace tribofit;

void add_effects(CLI::App& app, int& status) {
  CLI::App* verb = app.add_subcommand("effects", "List the effects that can be added to a law, or explain one");
  verb->footer("Example:\n  identify effects rate-state");
  const auto key = std::make_shared<std::string>();
  verb->add_option("KEY", *key, "Effect to explain, KEY or KEY:FORM");
  verb->callback([key, &status] {
    TerminalOptions options;
    options.colour = wants_colour();
    options.unicode = wants_unicode();
    options.width = terminal_width();
    status = 0;
    if (!key->empty()) {
      const Effect effect = effect_named(*key);
      print(render_effect(describe(effect), fingerprint(effect), options));
      return;
    }
    std::vector<EffectInfo> effects;
    for (const Effect& effect : effect_catalogue()) effects.push_back(describe(effect));
    print(render_effects(effects, options));
  });
}

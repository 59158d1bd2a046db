#include "verbs.hpp"

using namespace tribofit;

namespace {

ExitStatus run_rig(const Settings& s, bool keep_high_pass, const std::vector<std::string>& arguments) {
  IdentifyOptions options = options_from(s);
  options.motion.undo_high_pass = !keep_high_pass;
  const Input input = only_input(s, options.read, "rig");
  RigIdentification result = identify_rig(input.trace, options);
  return show_alone(s, input, result, arguments,
                    result.rig.determined ? "" : "the rig could not be identified: " + result.rig.reason);
}

}  // namespace

void add_rig(const Command& app) {
  const Command verb = app.add_verb(
      "rig", "Mass, damping and stiffness of the rig behind a trace",
      "Mass, damping and stiffness from N mu = m dv_b/dt + c v_b + k x, whatever the friction law is. Without\n"
      "--load (or a channel of it) they are per newton. A high-pass found on the vibrometer is undone first;\n"
      "--keep-high-pass shows what it does to the damping.\n\n"
      "Examples:\n"
      "  identify rig --radius 15mm --load 50N trace.csv\n"
      "  identify rig --radius 15mm --load 50N --instruments lab.json --json rig.json trace.csv");
  const auto settings = std::make_shared<Settings>();
  const auto keep = std::make_shared<bool>(false);
  add_input_options(verb, *settings);
  verb.in(section::kReading)
      .add_flag("--keep-high-pass", *keep,
                "Do not undo a high-pass found on the velocity (one that is declared is undone)");
  add_output_options(verb, *settings);
  verb.on_run([settings, keep, verb] { return run_rig(*settings, *keep, verb.own_options()); });
}
